// When LCLK stops, at whatever level and phase, everything is off within 35 edges of the 50 MHz
// crystal, and a live clock is believed only after 256 changes in a row. The flip-flop that LCLK
// clocks is cut: its output is any sequence of bits.
reg formal_toggle = 0, formal_dead = 1, formal_running = 0;
reg [5:0] formal_still = 0;   // edges of the crystal since the toggle was last seen to change

always @(posedge synclk) begin
    formal_running <= 1;
    formal_toggle <= toggle_q;
    formal_dead <= lclk_dead;
    formal_still <= toggle_q != formal_toggle ? 6'd0 : formal_still + !(&formal_still);
end

always @(*) begin
    if (!formal_running) assert (lclk_dead);
    if (formal_still >= 35) assert (lclk_dead);
    if (formal_running && formal_dead && !lclk_dead) assert (good_q == good_limit);
    // Invariants that carry the induction.
    assert (formal_toggle == first_q);
    if (second_q == first_q && last_q == second_q && alive_q) assert (formal_still <= silent_q + 7'd3);
    if (second_q != first_q) assert (formal_still == 0);
    if (second_q == first_q && last_q != second_q) assert (formal_still == 1);
end
