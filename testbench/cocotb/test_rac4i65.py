"""The emitted chip, driven as the PLX PCI 9030 drives it: identify, write, commit, arm, stop.

Run by FuseSoC (`fusesoc run --target sim racbot:gateware:rac4i65`) with Icarus. Offsets and magic
words come from generated/registers.json, so this file repeats none of them.
"""

import json
import os
import random
from pathlib import Path

import cocotb
from cocotb.clock import Clock
from cocotb.triggers import ClockCycles, FallingEdge, RisingEdge, Timer
from cocotb.types import LogicArray

GENERATED = Path(os.environ["RAC4I65_GENERATED"])
REGISTERS = {r["name"]: r for r in json.loads((GENERATED / "registers.json").read_text())["registers"]}
RELEASED = LogicArray("Z" * 32)
# ASCII words of the arm sequence and the seed of the checksum: see generated/registers.md.
ARM_FIRST, ARM_SECOND, SEED = 0x41524D31, 0x41524D32, 0x52414353
LONGEST_ANSWER = 66


def offset(name, index=0):
    return int(str(REGISTERS[name]["offset"]), 0) + 4 * index


class Bus:
    """Master of the multiplexed local bus; pins change at falling edges, are sampled at rising ones."""

    def __init__(self, dut):
        self.dut = dut

    def idle(self):
        self.dut.ads_n.value = 1
        self.dut.blast_n.value = 1
        self.dut.lw_r.value = 0
        self.dut.lad.value = RELEASED

    async def cycle(self, address, words=None, count=1):
        """One burst; gives the words read, or writes `words`."""
        dut, read = self.dut, []
        await FallingEdge(dut.lclk)
        dut.ads_n.value = 0
        dut.lw_r.value = int(words is not None)
        dut.lad.value = address
        await FallingEdge(dut.lclk)
        dut.ads_n.value = 1
        if words is None:
            # Once only: what is put on a tri-state net here stands until its driver changes.
            dut.lad.value = RELEASED
        else:
            count = len(words)
        for index in range(count):
            dut.blast_n.value = int(index + 1 < count)
            if words is not None:
                dut.lad.value = words[index]
            for _ in range(LONGEST_ANSWER):
                if dut.ready_n.value == 0:
                    break
                await FallingEdge(dut.lclk)
            assert dut.ready_n.value == 0, f"no READY# for {address:#x}"
            if words is None:
                read.append(int(dut.lad.value))
            await FallingEdge(dut.lclk)
        self.idle()
        return read

    async def read(self, name, index=0):
        return (await self.cycle(offset(name, index)))[0]

    async def write(self, name, word, index=0):
        await self.cycle(offset(name, index), [word])

    async def commit_set_points(self, words):
        sum_ = SEED
        for index, word in enumerate(words):
            await self.write("set_points", word, index)
            sum_ = ((sum_ << 1 | sum_ >> 31) & 0xFFFFFFFF) ^ word ^ (offset("set_points", index) // 4)
        await self.write("commit_set_points", sum_)


async def power_up(dut):
    """Clocks, quiet inputs, a closed emergency stop; waits until both clocks are believed."""
    for name in ("encoder_a", "encoder_b", "encoder_index", "ball_sensor", "emergency_stop", "kicker_full"):
        if hasattr(dut, name):
            getattr(dut, name).value = 0
    for name in ("host_select", "radio_rx"):
        getattr(dut, name).value = 1
    bus = Bus(dut)
    bus.idle()
    cocotb.start_soon(Clock(dut.lclk, 30, "ns").start())
    cocotb.start_soon(Clock(dut.synclk, 20, "ns").start())
    await ClockCycles(dut.lclk, 600)
    return bus


def all_off(dut):
    bridges = dut.enable_n.value == 0xF and dut.pwm.value == 0
    return bridges and dut.kicker_charge_n.value == 1 and dut.kicker_trigger_n.value == 1


@cocotb.test()
async def identification_and_plain_registers(dut):
    bus = await power_up(dut)
    assert (await bus.read("cookie")).to_bytes(4, "big") == b"RAC4"
    assert (await bus.read("board")).to_bytes(4, "big") == b"4I65"
    text = (GENERATED / "rac4i65.v").read_text()
    assert f"content_hash = 32'h{await bus.read('content_hash'):x};" in text.lower()
    for word in random.Random(1).sample(range(256), 8):
        await bus.write("leds", word)
        assert await bus.read("leds") == word
        await Timer(1, "ns")
        assert dut.led_n.value == 0xFF ^ word
    await bus.write("cookie", 0)
    assert await bus.cycle(0, count=3) == [await bus.read(n) for n in ("cookie", "map_version", "board")]
    assert await bus.cycle(0xFFF0, count=4) == [0, 0, 0, 0], "reserved words"


@cocotb.test()
async def armed_by_the_sequence_only_and_stopped_at_once(dut):
    bus = await power_up(dut)
    assert all_off(dut)
    await bus.write("arm", ARM_FIRST)
    await bus.write("arm", ARM_SECOND)
    assert all_off(dut), "armed although no commit ever petted the watchdog"
    await bus.commit_set_points([0, 0, 0, 0])
    # Lines that were open until the clock ran changed both at once.
    await bus.write("encoder_error", 0xF)
    await bus.write("arm", ARM_SECOND)
    assert all_off(dut), "one word armed it"
    await bus.write("arm", ARM_FIRST)
    await bus.write("arm", ARM_SECOND)
    assert await bus.read("status") & 1
    assert dut.enable_n.value == 0
    dut.emergency_stop.value = 1
    await ClockCycles(dut.lclk, 20)
    await RisingEdge(dut.lclk)
    assert all_off(dut)
    dut.emergency_stop.value = 0
    await ClockCycles(dut.lclk, 100)
    assert all_off(dut), "armed again by itself"
