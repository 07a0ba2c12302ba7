//! What the compiler makes of the march: whole vectors of the instruction set, nothing gathered number by number.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

mod problems;

use std::collections::BTreeMap;
use std::process::Command;

use problems::ensemble::{headline, run, samples};
use spanwise::ensemble::simd::Isa;

/// Products of whole vectors in the march at least, of the step and of the recovery; it has some fifteen hundred.
const PRODUCTS: usize = 500;

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

/// The march for an instruction set: of the functions that the dispatch compiled for it, that with the most products.
fn march(of: &str, width: usize) -> (String, Counts) {
    // So that the march is linked into this program.
    assert!(run(&headline(), &samples(1), Isa::Scalar, 1).results.failures.is_empty());
    let mut all: Vec<(String, Counts)> = compiled().into_iter().filter(|(name, _)| name.contains(of)).collect();
    all.sort_by_key(|(_, counts)| counts.products[width]);
    let march = all.pop().unwrap_or_else(|| panic!("no function is compiled for {of}"));
    println!("{}: {:?}", march.0, march.1);
    assert!(march.1.products[width] >= PRODUCTS, "{}: {:?} is not the march", march.0, march.1);
    march
}

#[test]
fn avx2_works_on_whole_vectors() {
    let (name, counts) = march("V3", 0);
    assert_eq!((counts.gathers, counts.scatters, counts.fused), (0, 0, 0), "{name}: {counts:?}");
}

/// Ignored as long as the compiler makes vectors across coordinates and modes there, for which it gathers.
#[test]
#[ignore = "gathers and scatters, see above"]
fn avx512_works_on_whole_vectors() {
    let (name, counts) = march("V4", 1);
    assert_eq!((counts.gathers, counts.scatters, counts.fused), (0, 0, 0), "{name}: {counts:?}");
}
