"""The `sim` target of rac4i65.core: builds the chip with Icarus and runs the cocotb test.

cocotb's own runner is used, because FuseSoC's back end ends well even where no test ran.
"""

import os
import sys
from pathlib import Path

from cocotb_tools.runner import get_results, get_runner

CHIP = "rac4i65"
MODULE = "test_rac4i65"
TIME = ("1ns", "1ns")


def main():
    generated = os.environ.get("RAC4I65_GENERATED")
    if generated is None:
        sys.exit("RAC4I65_GENERATED is not set: it names the folder generated/, with rac4i65.v and registers.json")
    here = Path(__file__).resolve().parent
    runner = get_runner("icarus")
    runner.build(
        sources=[Path(generated) / f"{CHIP}.v"],
        hdl_toplevel=CHIP,
        build_args=["-g2001"],
        timescale=TIME,
        build_dir=here / "cocotb",
    )
    results = runner.test(
        test_module=MODULE, hdl_toplevel=CHIP, timescale=TIME, build_dir=here / "cocotb", results_xml=here / "results.xml"
    )
    tests, failures = get_results(results)
    if tests == 0 or failures:
        sys.exit(f"cocotb: {tests} tests ran, {failures} failed")
    print(f"cocotb: {tests} tests passed")


main()
