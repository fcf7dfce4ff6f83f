// The strobes that others count: never more than 34 clocks between microseconds, never fewer than
// 1000 between ticks, unless the host restarts the tick (registers.v: only while disarmed).
reg [6:0] formal_gap = 0;      // clocks since the last microsecond strobe
reg [23:0] formal_apart = 0;   // clocks since the last tick or restart
always @(posedge clock) begin
    formal_gap <= microsecond ? 7'd1 : formal_gap + 7'd1;
    formal_apart <= restart ? 24'd0 : tick ? 24'd1 : formal_apart + 24'd1;
end
always @(*) begin
    assert (formal_gap <= 34);
    if (microsecond) assert (formal_gap >= 25);
    if (tick) assert (formal_apart >= 1000);
    if (window) assert (tick);
    assert (period >= 1000);
    // Invariants that carry the induction.
    assert (microsecond ? part_q == 1 : formal_gap + 7'd1 == part_q);
    assert (tick ? phase_q == 1 : formal_apart + 24'd1 == phase_q);
    assert (part_limit_q >= 25 && part_limit_q <= 34 && limit_q >= 1000);
end
