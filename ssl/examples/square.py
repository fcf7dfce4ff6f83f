#!/usr/bin/env python3
"""Drives a robot around squares through the sockets of `racbot serve` and records what it sent and what vision saw.

Nothing but Python's own library: the few messages are packed and unpacked here by hand. A team would use the classes that
protoc makes of the league's .proto files; the bytes are the same.

    racbot serve --blue 1 --yellow 0 --lock-step blue --vision-to 127.0.0.1:10020 --vision none --skew-deg 4,-3,2
    python3 square.py set            # writes set/run_1.csv ... with the columns of racbot

Positions, speeds and frames are the league's: metres, x forward. What is written is in racbot's body frame, x to the
right: cmd_vx = -left, cmd_vy = forward, and cam_theta is the heading of the body's x axis.
"""
import argparse
import csv
import math
import os
import socket
import struct
import time

# --- protobuf, as much of it as is needed -----------------------------------------------------------------------------


def varint(number):
    out = b""
    while number > 127:
        out += bytes([number & 127 | 128])
        number >>= 7
    return out + bytes([number])


def message(number, content):
    return varint(number << 3 | 2) + varint(len(content)) + content


def real(number, value):
    return varint(number << 3 | 5) + struct.pack("<f", value)


def local_velocity(robot, forward, left, angular):
    """RobotControl with one command by MoveLocalVelocity."""
    move = message(2, real(1, forward) + real(2, left) + real(3, angular))
    return message(1, varint(1 << 3) + varint(robot) + message(2, move))


def teleport(robot, team, x, y, orientation):
    """SimulatorCommand that puts a robot somewhere and the ball out of the way."""
    who = varint(1 << 3) + varint(robot) + varint(2 << 3) + varint({"yellow": 1, "blue": 2}[team])
    place = message(1, who) + real(2, x) + real(3, y) + real(4, orientation)
    ball = real(1, 4.0) + real(2, 2.5)
    return message(1, message(1, ball) + message(2, place))


def fields(data):
    """(number, value) of every field of a message."""
    at = 0

    def number():
        nonlocal at
        value, shift = 0, 0
        while True:
            byte = data[at]
            at += 1
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    while at < len(data):
        key = number()
        kind = key & 7
        if kind == 0:
            yield key >> 3, number()
        elif kind == 1:
            yield key >> 3, struct.unpack_from("<d", data, at)[0]
            at += 8
        elif kind == 5:
            yield key >> 3, struct.unpack_from("<f", data, at)[0]
            at += 4
        else:
            length = number()
            yield key >> 3, data[at : at + length]
            at += length


def seen(packet, team, robot):
    """Capture time (s), x, y (m) and orientation (rad) of a robot in an SSL_WrapperPacket."""
    detection = dict(fields(packet)).get(1)
    if detection is None:
        return None
    number = {"yellow": 6, "blue": 7}[team]
    stamp = dict(fields(detection))[2]
    for key, value in fields(detection):
        if key == number:
            one = dict(fields(value))
            if one.get(2) == robot:
                return stamp, one[3] / 1000, one[4] / 1000, one[5]
    return None


# --- the drive --------------------------------------------------------------------------------------------------------


def square(side, speed, acceleration, turn):
    """Local velocities (forward, left) and turn rate, a frame each, around a square, with ramps at its corners."""
    step = 1 / 60
    ramp = speed / acceleration
    for edge in range(4):
        direction = edge * math.pi / 2
        t, length = 0.0, side / speed + ramp
        while t < length:
            now = speed * max(0.0, min(1.0, t / ramp, (length - t) / ramp))
            yield now * math.cos(direction), now * math.sin(direction), 0.0
            t += step
    # Once around on the spot, which tells the lever of the wheels.
    t, length, ramp = 0.0, 2 * math.pi / abs(turn) + 0.5, 0.5
    while t < length:
        yield 0.0, 0.0, turn * max(0.0, min(1.0, t / ramp, (length - t) / ramp))
        t += step


def ask(commands, datagram, server):
    """Sends until there is an answer: the server may not have begun yet."""
    commands.settimeout(1)
    for _ in range(30):
        try:
            commands.sendto(datagram, server)
            return commands.recv(65535)
        except (ConnectionRefusedError, TimeoutError, socket.timeout):
            time.sleep(0.1)
    raise SystemExit(f"no answer from {server}: is racbot serve running?")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", help="folder for the runs")
    parser.add_argument("--team", choices=["blue", "yellow"], default="blue")
    parser.add_argument("--robot", type=int, default=0)
    parser.add_argument("--server", default="127.0.0.1")
    parser.add_argument("--ports", default="10300,10301,10302", help="control, blue, yellow")
    parser.add_argument("--vision", type=int, default=10020, help="port that --vision-to names")
    parser.add_argument("--runs", type=int, default=4)
    parser.add_argument("--speed", type=float, default=0.5, help="m/s")
    options = parser.parse_args()
    control, blue, yellow = (int(port) for port in options.ports.split(","))
    team = (options.server, blue if options.team == "blue" else yellow)
    vision = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    vision.bind(("127.0.0.1", options.vision))
    vision.settimeout(10)
    commands = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    os.makedirs(options.folder, exist_ok=True)
    for run in range(1, options.runs + 1):
        heading = (run - 1) * 2 * math.pi / options.runs
        ask(commands, teleport(options.robot, options.team, 0, 0, heading), (options.server, control))
        turn = 2.0 if run % 2 else -2.0
        rest = [(0.0, 0.0, 0.0)] * 20
        rows, pose = [], None
        for forward, left, angular in rest + list(square(0.8, options.speed, 0.5, turn)) + rest:
            if pose is not None:
                # A row is the pose at a time and the command from then on.
                stamp, x, y, orientation = pose
                theta = math.remainder(orientation - math.pi / 2, 2 * math.pi)
                rows.append((stamp, -left, forward, angular, x, y, theta))
            ask(commands, local_velocity(options.robot, forward, left, angular), team)
            pose = seen(vision.recv(65535), options.team, options.robot)
        with open(os.path.join(options.folder, f"run_{run}.csv"), "w", newline="") as file:
            table = csv.writer(file)
            table.writerow(["t", "cmd_vx", "cmd_vy", "cmd_w", "cam_x", "cam_y", "cam_theta"])
            table.writerows([f"{row[0] - rows[0][0]:.4f}", *(f"{value:.6f}" for value in row[1:])] for row in rows)
        print(f"run {run}: {len(rows)} frames")


if __name__ == "__main__":
    main()
