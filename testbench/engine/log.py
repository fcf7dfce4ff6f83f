"""The text of a run, as in the example logs."""


def header(wheels, with_duty):
    """The names of the columns."""
    of = [f"{stem}_{i + 1}" for stem in ("ref", "enc", *(["duty"] if with_duty else [])) for i in range(wheels)]
    return ",".join(["t", "cmd_vx", "cmd_vy", "cmd_w", *of, "supply_v", "cam_x", "cam_y", "cam_theta"])


def decimals(value, places):
    """No trailing zeros, no negative zero."""
    text = f"{value:.{places}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def text(rows, frames, with_duty=True):
    """Rows (t, command, references, counts, duties, supply), frames {row: pose}."""
    lines = [header(len(rows[0][2]), with_duty)]
    for number, (t, command, references, counts, duties, supply) in enumerate(rows):
        cells = [decimals(t, 3)]
        cells += [decimals(c, 3) for c in command]
        cells += [decimals(r, 2) for r in references]
        cells += [str(c) for c in counts]
        cells += [decimals(u, 3) for u in duties] if with_duty else []
        cells.append(decimals(supply, 2))
        cells += [decimals(c, 4) for c in frames[number]] if number in frames else ["", "", ""]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"
