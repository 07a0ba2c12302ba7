//! What the compiler makes of the march: whole vectors of the instruction set, nothing gathered number by number.
//!
//! The functions are known by who calls them: what [`ROOMS`] give to the dispatch. Their own symbols name the dispatch
//! alone, and libraries, which may fuse, use it too.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use crate::problems::ensemble::{headline, run, samples};
use spanwise::lane::Isa;

/// Products of whole vectors in the steps of any vehicle, at least; they have a thousand or more.
const PRODUCTS: usize = 300;

/// And in the steps and in the search for extremes of the usual sizes, each in a function of its own, of which there are
/// so many.
const OF_OWN: usize = 50;
const OWN: usize = 16;

/// The rooms of steps and roads, histories, and extremes.
const ROOMS: [&str; 3] = ["ensemble", "crossing", "extremes"];

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

impl Counts {
    fn add(&mut self, instruction: &str) {
        let name = instruction.split_whitespace().next().unwrap_or_default();
        self.products[0] += usize::from(name == "vmulpd" && instruction.contains("%ymm"));
        self.products[1] += usize::from(name == "vmulpd" && instruction.contains("%zmm"));
        self.gathers += usize::from(name.starts_with("vgather") || name.starts_with("vpgather"));
        self.scatters += usize::from(name.starts_with("vscatter") || name.starts_with("vpscatter"));
        self.fused += usize::from(name.starts_with("vfm") || name.starts_with("vfnm"));
    }
}

/// Whether the dispatch compiled this function for an instruction set.
fn is_dispatched(symbol: &str) -> bool {
    symbol.contains("pulp") && symbol.contains("vectorize")
}

/// Whether a function is of one of the rooms, or belongs to a type of theirs.
fn is_ours(symbol: &str) -> bool {
    let paths = |room: &str| [format!("8spanwise{}{room}", room.len()), format!("spanwise..{room}")];
    ROOMS.into_iter().flat_map(paths).any(|path| symbol.contains(&path))
}

/// Whether a function is of the files in which samples go their own ways, where each looks up a road of its own.
fn is_apart(symbol: &str) -> bool {
    ["7abreast", "8own_ways"].into_iter().any(|file| symbol.contains(file))
}

/// Counts in all functions of this program that the rooms dispatch, and whether for samples on their own ways.
fn march() -> BTreeMap<String, (Counts, bool)> {
    let own = std::env::current_exe().unwrap();
    let output = Command::new("objdump").args(["--disassemble", "--no-show-raw-insn"]).arg(&own).output();
    let output = match output {
        Ok(output) if output.status.success() => output,
        other => panic!("this test needs objdump of the GNU binutils: {other:?}"),
    };
    let text = String::from_utf8_lossy(&output.stdout);
    let mut functions: BTreeMap<String, Counts> = BTreeMap::new();
    let (mut called, mut apart, mut current) = (BTreeSet::new(), BTreeSet::new(), "");
    for line in text.lines() {
        // "0000000000101530 <symbol>:" begins a function, "call 101530 <symbol>" goes to one.
        let symbol = line.split_once(" <").map(|(_, rest)| rest.trim_end_matches([':', '>']));
        if let Some(symbol) = symbol.filter(|_| line.ends_with(">:")) {
            current = symbol;
        } else if let Some((_, instruction)) = line.split_once('\t') {
            if is_dispatched(current) {
                functions.entry(current.to_string()).or_default().add(instruction);
            } else if is_ours(current) {
                let dispatched = symbol.filter(|symbol| is_dispatched(symbol)).map(str::to_string);
                if is_apart(current) { &mut apart } else { &mut called }.extend(dispatched);
            }
        }
    }
    let known = functions.into_iter().filter(|(symbol, _)| called.contains(symbol) || apart.contains(symbol));
    known
        .map(|(symbol, counts)| {
            let own = apart.contains(&symbol);
            (symbol, (counts, own))
        })
        .collect()
}

/// Refuses a march that is not all of whole vectors, with `of` an instruction set and `width` the place of its products.
fn check(of: &str, width: usize) {
    // So that the march is linked into this program.
    assert!(run(&headline(), &samples(1), Isa::Baseline, 1).results.failures.is_empty());
    let functions: BTreeMap<String, (Counts, bool)> =
        march().into_iter().filter(|(symbol, _)| symbol.contains(of)).collect();
    let with = |least: usize| functions.values().filter(|(counts, _)| counts.products[width] >= least).count();
    assert!(with(PRODUCTS) >= 1, "{of}: the steps of any vehicle are not among {functions:#?}");
    assert!(with(OF_OWN) >= OWN, "{of}: steps and search of the usual sizes are not among {functions:#?}");
    for (symbol, (counts, apart)) in functions {
        assert_eq!(counts.fused, 0, "{symbol}");
        assert!(apart || (counts.gathers, counts.scatters) == (0, 0), "{symbol}: {counts:?}");
    }
}

#[test]
fn avx2_works_on_whole_vectors() {
    check("V3", 0);
}

#[test]
fn avx512_works_on_whole_vectors() {
    check("V4", 1);
}
