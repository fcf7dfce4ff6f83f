//! The register documents in a stranger's hands: the C header compiled as C and C++, and a driver in Python
//! that knows the card from `registers.json` alone.

use fixed_kin::registers::{CHECKSUM_SEED, Kind, REGISTERS, VERSION};
use std::fmt::Write as _;
use std::process::Command;
use testbench::repository;

/// Runs a tool that must succeed and gives what it printed.
fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; see the README for the tools"));
    let text = [&output.stdout[..], &output.stderr[..]].map(String::from_utf8_lossy).concat();
    assert!(output.status.success(), "{command:?}: {text}");
    text
}

#[test]
fn the_header_compiles_as_c_and_cpp_and_its_names_are_the_map() {
    let folder = tempfile::tempdir().unwrap();
    let mut names = vec![("THIS_MAP_VERSION".to_owned(), VERSION), ("CHECKSUM_SEED".to_owned(), CHECKSUM_SEED)];
    for r in REGISTERS {
        let name = r.name.to_uppercase();
        names.push((name.clone(), r.offset.into()));
        if let Kind::Fields(fields) = r.kind {
            let field = |f: &str| format!("{name}_{}", f.to_uppercase().replace('-', "_"));
            names.extend(fields.iter().map(|f| (field(f.name), f.place(u32::MAX))));
        }
        names.extend(r.groups.iter().map(|g| (format!("{name}_{}", g.name.to_uppercase()), r.at(g.first).into())));
        names.extend(r.values.iter().map(|v| (format!("{name}_VALUE_{}", v.name.to_uppercase()), v.word)));
    }
    let mut program = String::from("#include <stdio.h>\n#include \"registers.h\"\nint main(void) {\n");
    for (name, value) in &names {
        let _ = writeln!(program, "    if (RAC4I65_{name} != 0x{value:x}u) {{ puts(\"{name}\"); return 1; }}");
    }
    program += "    puts(\"all right\");\n    return 0;\n}\n";
    for (compiler, source, standard) in [("gcc", "a.c", "-std=c99"), ("g++", "a.cpp", "-std=c++11")] {
        std::fs::write(folder.path().join(source), &program).unwrap();
        run(Command::new(compiler)
            .args([standard, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-o", "a", source, "-I"])
            .arg(repository().join("generated"))
            .current_dir(folder.path()));
        assert_eq!(run(&mut Command::new(folder.path().join("a"))), "all right\n", "{compiler}, {} names", names.len());
    }
}

#[test]
fn a_driver_from_the_json_alone_identifies_arms_configures_drives_and_kicks() {
    let folder = tempfile::tempdir().unwrap();
    let (root, compiled) = (repository(), folder.path().join("pins.vvp"));
    run(Command::new("iverilog").args(["-g2001", "-s", "pins", "-o"]).args([
        &compiled,
        &root.join("testbench/documents/pins.v"),
        &root.join("generated/rac4i65.v"),
    ]));
    let text = run(Command::new("python3")
        .arg(root.join("testbench/documents/driver.py"))
        .args([&root.join("generated"), &compiled]));
    assert!(text.ends_with("all as registers.json says\n"), "{text}");
    print!("{text}");
}
