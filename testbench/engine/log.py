"""The text of a run, as in the example logs."""

HEADER = "t,cmd_vx,cmd_vy,cmd_w,ref_1,ref_2,ref_3,enc_1,enc_2,enc_3,duty_1,duty_2,duty_3,supply_v,cam_x,cam_y,cam_theta"


def decimals(value, places):
    """No trailing zeros, no negative zero."""
    text = f"{value:.{places}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def text(rows, frames):
    """Rows (t, command, references, counts, duties, supply), frames {row: pose}."""
    lines = [HEADER]
    for number, (t, command, references, counts, duties, supply) in enumerate(rows):
        cells = [decimals(t, 3)]
        cells += [decimals(c, 3) for c in command]
        cells += [decimals(r, 2) for r in references]
        cells += [str(c) for c in counts]
        cells += [decimals(u, 3) for u in duties]
        cells.append(decimals(supply, 2))
        cells += [decimals(c, 4) for c in frames[number]] if number in frames else ["", "", ""]
        lines.append(",".join(cells))
    return "\n".join(lines) + "\n"
