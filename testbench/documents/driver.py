"""A driver written from generated/registers.json alone, for the chip behind the pins of pins.v.

usage: driver.py GENERATED COMPILED

GENERATED is the folder with registers.json and rac4i65.v, COMPILED the bench as iverilog made it. Every
offset, word, format and rule is looked up; what the file does not say this driver does not know. It prints
what it checked and ends with an error at the first thing that is not as the file says.
"""

import json
import re
import subprocess
import sys
import zlib
from pathlib import Path

PINS = ["emergency_stop", "ball_sensor", "kicker_full", "radio_rx", "host_select", "encoder_a", "encoder_b", "encoder_index",
        "robot_number"]
MASK = 0xFFFFFFFF


class Chip:
    """Bus and pins through the pipe."""

    def __init__(self, compiled):
        command = ["vvp", "-n", "-N", compiled]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, command, first=0, second=0):
        self.process.stdin.write(f"{command} {first:x} {second:x}\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        assert answer and answer not in ("silent", "unknown"), f"{command} {first:x} {second:x}: {answer!r}"
        return answer

    def clocks(self, count):
        self.ask("c", count)

    def pin(self, name, level):
        self.ask("p", PINS.index(name), level)

    def outputs(self):
        words = self.ask("o").split()
        names = ["dir", "enable_n", "charge_n", "trigger_n", "discharge"]
        levels = {name: int(word, 2) for name, word in zip(names, words)}
        return levels | {"pwm": [int(word) for word in words[5:9]], "trigger_clocks": int(words[9])}


class Card:
    """Registers by name, as the file describes them."""

    def __init__(self, chip, document):
        self.chip = chip
        self.document = document
        self.table = {register["name"]: register for register in document["registers"]}

    def offset(self, name, index=0):
        assert index < self.table[name]["words"]
        return self.table[name]["offset"] + 4 * index

    def read(self, name, index=0):
        answer = self.chip.ask("r", self.offset(name, index))
        assert re.fullmatch("[0-9a-f]{8}", answer), f"{name}[{index}] reads {answer}"
        return int(answer, 16)

    def write(self, name, word, index=0):
        self.chip.ask("w", self.offset(name, index), word & MASK)

    def value(self, name, which):
        return self.table[name]["values"][which]["word"]

    def field(self, name, field, word=None):
        """The field's value in a word, or in what the register reads."""
        word = self.read(name) if word is None else word
        found = next(f for f in self.table[name]["fields"] if f["name"] == field)
        return word >> found["bit"] & (1 << found["width"]) - 1

    def bits(self, name, **fields):
        """A word with these fields set; a dash in a name is an underscore here."""
        word = 0
        for field in self.table[name]["fields"]:
            word |= fields.pop(field["name"].replace("-", "_"), 0) << field["bit"]
        assert not fields, f"{name} has no {fields}"
        return word

    def checksum(self, name, words):
        total = self.document["checksum"]["seed"]
        for index, word in enumerate(words):
            total = ((total << 1 | total >> 31) & MASK) ^ (word & MASK) ^ self.offset(name, index) // 4
        return total

    def commit(self, name, words, wrong=0):
        for index, word in enumerate(words):
            self.write(name, word, index)
        commit = next(c["commit"] for c in self.document["commits"] if c["words"] == name)
        self.write(commit, self.checksum(name, words) ^ wrong)

    def configuration(self, **groups):
        """The words of the bank; a value per axis, in the unit of its group."""
        words = [0] * self.table["configuration"]["words"]
        for group in self.table["configuration"]["groups"]:
            values = groups.pop(group["name"], [0] * group["words"])
            for index, value in enumerate(values):
                word = round(value * 2 ** group["fraction_bits"])
                limit = 1 << group["bits"] - 1
                assert -limit <= word < limit, f"{group['name']} {value}"
                words[group["first"] + index] = word
        assert not groups, f"no groups {groups}"
        return words

    def signed(self, name, index=0):
        word = self.read(name, index)
        return word - (word >> 31 << 32)

    def arm(self):
        for which in ("first", "second"):
            self.write("arm", self.value("arm", which))
        return self.field("status", "armed")

    def snapshot(self):
        """Sequence, and the other words by name and index."""
        sequence = self.read("snapshot_sequence")
        names = [n for n in self.table if n.startswith("snapshot_") and not n.startswith("snapshot_sequence")]
        words = {n: [self.signed(n, i) for i in range(self.table[n]["words"])] for n in names}
        assert self.read("snapshot_sequence_end") == sequence, "torn"
        return sequence, words


def reset_values(card):
    """Before anything is connected and before the first tick."""
    count = 0
    for name, register in card.table.items():
        for index in range(register["words"]):
            word = card.read(name, index)
            live = register["live"] if name == "time" else 0
            assert (word ^ register["reset"]) & ~live == 0, f"{name}[{index}] reads {word:#x}, reset {register['reset']:#x}"
            count += 1
    print(f"{count} words read their reset values")


def identify(card, folder):
    document = card.document
    assert card.read("cookie").to_bytes(4, "big") == b"RAC4"
    major, minor = document["map_version"].split(".")
    assert card.read("map_version") == int(major) << 16 | int(minor)
    board = next(b for b in document["boards"] if b["board"] == card.read("board"))
    assert board["name"] == "4I65" and card.read("clock_hz") == board["clock_hz"]
    verilog = (folder / "rac4i65.v").read_bytes()
    zeroed, count = re.subn(rb"(localparam content_hash = 32'h)[0-9a-f]{8};", rb"\g<1>00000000;", verilog)
    assert count == 1 and zlib.crc32(zeroed) == card.read("content_hash") == int(document["content_hash"], 16)
    example = document["checksum"]["example"]
    assert card.checksum("set_points", example["set_points"]) == example["checksum"]
    print(f"a {board['name']} with map {document['map_version']}, hash and example of the checksum are right")


def refusals(card):
    """Faults are cleared by ones; arming follows its rule."""
    assert not card.arm(), "armed although the watchdog stands"
    card.commit("set_points", [0] * 4, wrong=1)
    faults = card.read("faults")
    assert card.field("faults", "arm-refused", faults) and card.field("faults", "commit", faults)
    card.write("faults", card.bits("faults", arm_refused=1))
    assert card.read("faults") == faults & ~card.bits("faults", arm_refused=1), "a one clears its bit alone"
    card.commit("set_points", [0] * 4)
    assert not card.field("status", "armed") and card.field("faults", "commit")
    assert card.arm(), "a bit of a cause that is gone keeps from arming"
    card.write("arm", 0)
    assert not card.field("status", "armed")
    card.write("faults", MASK)
    assert card.read("faults") == 0 and card.read("first_fault") == 0
    print("faults are cleared by ones, arming goes by its rule")


def configure(card):
    """Feed-forward alone: duty = kff * set point, so that a set point is a duty."""
    full = 2 ** 29 - 1
    for name, word in [("tick_period", 1000), ("pwm_period", 800), ("clocks_per_us", 25), ("kicker_pulse", 20),
                       ("kicker_charge_timeout", 2000), ("kicker_lockout", 0), ("encoder_filter", 3)]:
        card.write(name, word)
        assert card.read(name) == word
    step = full / 2 ** 32
    words = card.configuration(kff=[1.0] * 4, lower=[-1.0] * 4, upper=[1.0] * 4, rise=[step] * 4, fall=[-step] * 4)
    card.commit("configuration", words)
    while card.field("status", "configuration-pending"):
        card.chip.clocks(100)
    card.chip.clocks(1000)
    active = [card.signed("active_configuration", index) for index in range(len(words))]
    assert active == words, "another configuration is in force"
    print(f"{len(words)} words of configuration in force")


def drive(card):
    chip = card.chip
    duty_bits = card.table["snapshot_duty"]["fraction_bits"]
    wanted = [0.5, -0.25, 1.0, 0.0]
    card.commit("set_points", [0] * 4)
    assert card.arm() and chip.outputs()["enable_n"] == 0
    card.commit("set_points", [round(duty * 2 ** duty_bits) for duty in wanted])
    chip.clocks(3000)
    sequence, words = card.snapshot()
    assert card.field("snapshot_status", "armed", words["snapshot_status"][0])
    assert [duty / 2 ** duty_bits for duty in words["snapshot_duty"]] == wanted, words
    chip.outputs()
    chip.clocks(8000)
    seen = chip.outputs()
    for axis, duty in enumerate(wanted):
        assert abs(seen["pwm"][axis] - 8000 * abs(duty)) <= 400, f"axis {axis}: {seen}"
        assert (seen["dir"] >> axis & 1) == (duty < 0), f"axis {axis}: {seen}"
    start = words["snapshot_count"]
    gray = [0b00, 0b01, 0b11, 0b10]
    for step in range(1, 10):
        lines = gray[step % 4]
        chip.pin("encoder_a", lines & 1)
        chip.pin("encoder_b", lines >> 1)
        chip.clocks(20)
    chip.clocks(2200)
    later, words = card.snapshot()
    age = card.read("time") - words["snapshot_time"][0] & 0xFFFFFF
    assert later > sequence and age < 1000 + 1000 + 60 * 20, (sequence, later, age)
    assert words["snapshot_count"][0] - start[0] == 9 and words["snapshot_count"][1:] == start[1:], words
    print(f"drove {wanted}, tick {later}, counted 9 edges")


def kick(card):
    chip = card.chip
    card.write("kicker_control", card.bits("kicker_control", charge=1, by_time=1))
    chip.clocks(200)
    assert chip.outputs()["charge_n"] == 0 and card.field("kicker_status", "ready")
    card.write("kicker_control", 0)
    card.write("kicker_fire", card.value("kicker_fire", "fire") ^ 1)
    chip.clocks(200)
    seen = chip.outputs()
    assert seen["charge_n"] == 1 and seen["trigger_clocks"] == 0
    card.write("kicker_fire", card.value("kicker_fire", "fire"))
    chip.clocks(1100 * 25)
    seen = chip.outputs()
    assert seen["trigger_clocks"] == 20 * 25 and seen["trigger_n"] == 1, seen
    card.write("kicker_fire", card.value("kicker_fire", "fire"))
    assert card.field("kicker_status", "fire-dropped") and card.field("kicker_status", "state") == 4
    print("charged, and kicked for 20 us")


def stop(card):
    chip = card.chip
    chip.pin("emergency_stop", 1)
    chip.clocks(25)
    seen = chip.outputs()
    assert seen["enable_n"] == 0xF and not card.field("status", "armed") and card.field("first_fault", "emergency-stop")
    card.commit("set_points", [0] * 4)
    assert not card.arm(), "armed in an emergency stop"
    chip.pin("emergency_stop", 0)
    chip.clocks(30)
    assert not card.field("status", "armed") and card.arm(), "does not arm once the cause is gone"
    print("stopped, stayed off, and could be armed again")


def main(folder, compiled):
    folder = Path(folder)
    card = Card(Chip(compiled), json.loads((folder / "registers.json").read_text()))
    card.chip.clocks(40)
    reset_values(card)
    for name in PINS:
        card.chip.pin(name, {"radio_rx": 1, "host_select": 1, "kicker_full": 1, "robot_number": 15}.get(name, 0))
    card.chip.clocks(600)
    card.write("encoder_error", MASK)
    card.write("stall", MASK)
    identify(card, folder)
    refusals(card)
    configure(card)
    drive(card)
    kick(card)
    stop(card)
    card.chip.process.stdin.close()
    assert card.chip.process.wait(60) == 0
    print("all as registers.json says")


if __name__ == "__main__":
    main(*sys.argv[1:])
