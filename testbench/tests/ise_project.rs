//! The project for Xilinx ISE, as far as it can be tried without ISE: `make` calls the tools in order
//! with files that exist, here with stand-ins that note how they were called.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

const STAND_IN: &str = r#"#!/bin/sh
echo "$(basename "$0") $*" >> calls
for word in "$@"; do
    case $word in
        -*|xc2s200*|b|high|10|build|build/*) ;;
        *) [ -f "$word" ] || { echo "$0: no file $word" >&2; exit 1; } ;;
    esac
done
case $(basename "$0") in
    xst) touch "$(sed -n 's/^-ofn //p' rac4i65.xst)"; [ -f "$(sed -n 's/^-ifn //p' rac4i65.xst)" ] ;;
    ngdbuild) [ -f build/rac4i65.ngc ] && touch build/rac4i65.ngd ;;
    map) [ -f build/rac4i65.ngd ] && touch build/rac4i65_map.ncd build/rac4i65.pcf ;;
    par) [ -f build/rac4i65_map.ncd ] && touch build/rac4i65.ncd ;;
    trce) [ -f build/rac4i65.pcf ] && touch build/rac4i65.twr ;;
    bitgen) [ -f build/rac4i65.ncd ] && touch build/rac4i65.bit ;;
esac
"#;

fn make(folder: &Path, path: &str) -> Output {
    Command::new("make").current_dir(folder).env("PATH", path).output().expect("make: Debian package make")
}

#[test]
fn make_calls_the_tools_in_order() {
    let scratch = tempfile::tempdir().unwrap();
    let generated = Path::new(env!("CARGO_MANIFEST_DIR")).join("../generated");
    for entry in fs::read_dir(generated).unwrap() {
        let entry = entry.unwrap();
        if entry.file_type().unwrap().is_file() {
            fs::copy(entry.path(), scratch.path().join(entry.file_name())).unwrap();
        }
    }
    let missing = make(scratch.path(), "/usr/bin:/bin");
    assert!(!missing.status.success());
    assert!(String::from_utf8_lossy(&missing.stderr).contains("settings32.sh of Xilinx ISE 10.1"));

    let tools = scratch.path().join("tools");
    fs::create_dir(&tools).unwrap();
    for tool in ["xst", "ngdbuild", "map", "par", "trce", "bitgen"] {
        let file = tools.join(tool);
        fs::write(&file, STAND_IN).unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let made = make(scratch.path(), &format!("{}:/usr/bin:/bin", tools.display()));
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let calls = fs::read_to_string(scratch.path().join("calls")).unwrap();
    let mut names: Vec<_> = calls.lines().map(|call| call.split(' ').next().unwrap()).collect();
    names.sort_by_key(|name| *name == "trce");
    assert_eq!(names, ["xst", "ngdbuild", "map", "par", "bitgen", "trce"]);
    assert!(scratch.path().join("build/rac4i65.bit").is_file());
}

#[test]
fn the_project_names_what_is_there() {
    let read =
        |name: &str| fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../generated").join(name)).unwrap();
    assert!(read("rac4i65.xst").contains("-shreg_extract NO\n"));
    assert!(read("rac4i65.xst").contains("-p xc2s200-5-pq208\n"));
    assert_eq!(read("rac4i65.prj"), "verilog work \"rac4i65.v\"\n");
    let hash = hdl::design::content_hash();
    assert!(read("rac4i65.ut").contains(&format!("UserID:0x{hash:08X}")));
    for constraint in ["PERIOD \"lclk\" 30 ns", "OFFSET = IN", "OFFSET = OUT"] {
        assert!(read("rac4i65.ucf").contains(constraint), "{constraint}");
    }
}
