//! What the compiler makes of the march: whole vectors of the instruction set, nothing gathered number by number.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

use std::collections::BTreeMap;
use std::process::Command;

use crate::problems::ensemble::{headline, run, samples};
use spanwise::lane::Isa;

/// Products of whole vectors in the steps and in the recovery, at least; with AVX2 each has some eight hundred.
const PRODUCTS: usize = 300;

/// What is counted in a function.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    /// Products of vectors of four and of eight numbers.
    products: [usize; 2],
    /// Loads and stores number by number.
    gathers: usize,
    scatters: usize,
    /// Products and sums rounded once only.
    fused: usize,
}

/// Counts in all functions of this program that the dispatch compiled for an instruction set.
fn compiled() -> BTreeMap<String, Counts> {
    let own = std::env::current_exe().unwrap();
    let output = Command::new("objdump").args(["--disassemble", "--no-show-raw-insn"]).arg(&own).output();
    let output = match output {
        Ok(output) if output.status.success() => output,
        other => panic!("this test needs objdump of the GNU binutils: {other:?}"),
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let mut functions: BTreeMap<String, Counts> = BTreeMap::new();
    let mut current = None;
    for line in text.lines() {
        // "0000000000101530 <symbol>:" begins a function.
        if let Some((_, rest)) = line.split_once(" <").filter(|_| line.ends_with(">:")) {
            let name = rest.trim_end_matches(">:");
            let dispatched = name.contains("pulp") && name.contains("vectorize");
            current = dispatched.then(|| functions.entry(name.to_string()).or_default());
            continue;
        }
        let (Some(counts), Some((_, instruction))) = (current.as_deref_mut(), line.split_once('\t')) else { continue };
        let name = instruction.split_whitespace().next().unwrap_or_default();
        counts.products[0] += usize::from(name == "vmulpd" && instruction.contains("%ymm"));
        counts.products[1] += usize::from(name == "vmulpd" && instruction.contains("%zmm"));
        counts.gathers += usize::from(name.starts_with("vgather") || name.starts_with("vpgather"));
        counts.scatters += usize::from(name.starts_with("vscatter") || name.starts_with("vpscatter"));
        counts.fused += usize::from(name.starts_with("vfm") || name.starts_with("vfnm"));
    }
    functions
}

/// All that the dispatch compiled for an instruction set: steps, recovery and roads. Fused products are counted in the two
/// largest of these functions, steps and recovery, for libraries may fuse where they dispatch by the same means.
fn march(of: &str, width: usize) -> Counts {
    // So that the march is linked into this program.
    assert!(run(&headline(), &samples(1), Isa::Baseline, 1).results.failures.is_empty());
    let mut all: Vec<Counts> =
        compiled().into_iter().filter(|(name, _)| name.contains(of)).map(|(_, counts)| counts).collect();
    all.sort_by_key(|counts| std::cmp::Reverse(counts.products[width]));
    let [steps, recovery] = [all[0], all[1]];
    println!("{of}: {steps:?}, {recovery:?} and {} more", all.len() - 2);
    assert!(steps.products[width].min(recovery.products[width]) >= PRODUCTS, "{of}: these are not the march");
    Counts {
        products: steps.products,
        gathers: all.iter().map(|counts| counts.gathers).sum(),
        scatters: all.iter().map(|counts| counts.scatters).sum(),
        fused: steps.fused + recovery.fused,
    }
}

#[test]
fn avx2_works_on_whole_vectors() {
    let counts = march("V3", 0);
    assert_eq!((counts.gathers, counts.scatters, counts.fused), (0, 0, 0), "{counts:?}");
}

#[test]
fn avx512_works_on_whole_vectors() {
    let counts = march("V4", 1);
    assert_eq!((counts.gathers, counts.scatters, counts.fused), (0, 0, 0), "{counts:?}");
}
