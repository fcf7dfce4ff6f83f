// With bursts, every tick has one, over at most 971 clocks after the tick whatever the sensor says, in the bank
// of that tick and no other; the clock of the line moves only while the sensor is selected, and chip select ends
// each transfer at the idle level. Without, nothing is written but the age "none", and accesses alone select the
// sensor, for at most 136 clocks. Assumed: at least 1000 clocks between ticks (timebase.v); the settings change
// only while disarmed and the line is quiet (below they may change at any clock but that of a running transfer).
localparam FORMAL_APART = 999, FORMAL_BURST = 968, FORMAL_ACCESS = 136;
reg formal_running = 0;
reg [10:0] formal_since = FORMAL_APART;  // clocks since the tick, saturated
reg [10:0] formal_selected = 0;          // clocks of this transfer before this one
reg formal_idle = 0, formal_cs_n = 1, formal_reading = 0, formal_tick = 0, formal_due = 0, formal_live = 0;
reg [7:0] formal_bits = 0;  // read in this transfer so far
reg [1:0] formal_half = 0;
reg [1:0] formal_bank = 0;
wire formal_rests = halves_q == 255 || halves_q == (burst_q ? 14 : 222);  // lead or trail

always @(posedge clock) begin
    formal_running <= 1;
    formal_since <= tick ? 11'd0 : formal_since + (formal_since < FORMAL_APART);
    formal_selected <= cs_n ? 11'd0 : formal_selected + 11'd1;
    formal_idle <= idle_high;
    formal_cs_n <= cs_n;
    formal_reading <= reading;
    formal_tick <= tick;
    formal_due <= live_q && starts_q;
    formal_live <= live_q;
    formal_bits <= cs_n ? 8'd0 : formal_bits + (edge_now && !sclk && low_half && halves_q != 255);
    formal_half <= half;
    formal_bank <= bank;
end

always @(*) begin
    if (tick) assume (formal_since >= FORMAL_APART);
    if (!cs_n) assume (half == formal_half && idle_high == formal_idle);
    if (!formal_tick) assume (bank == formal_bank);
    // A tick has its burst, and it ends in time.
    if (formal_due) assert (reading);
    if (reading && formal_cs_n) assert (formal_live);
    if (live_q && !cs_n) assert (reading);
    if (reading) assert (formal_since < FORMAL_BURST + 2);
    if (tick) assert (!reading);
    if (!cs_n && reading) assert (formal_selected < FORMAL_BURST);
    if (!cs_n && !reading) assert (formal_selected < FORMAL_ACCESS);
    // The line.
    if (formal_running && (cs_n || formal_cs_n)) assert (sclk == formal_idle);
    // What is written: the age at the tick, then words of the burst.
    if (words_write_enable) assert (words_write_address[4:3] == bank && words_write_address[7:5] == 0);
    if (words_write_enable && !reading) assert (starts_q && words_write_address[2:0] == 0);
    if (words_write_enable && !starts_q) assert (words_write_address[2:0] != 0 && words_write_data == shift_q);
    if (words_write_enable && starts_q && !live_q) assert (words_write_data == 16'hffff || left_q != 0);
    if (words_write_enable && !starts_q) assert (formal_bits == 8 + 16 * words_write_address[2:0]);
    // Bursts and accesses exclude each other.
    if (reading) assert (!cs_n);
    if (formal_running && !formal_cs_n && !cs_n) assert (reading == formal_reading);
    // Invariants that carry the induction.
    if (run_q) assert (clock_high_q == (formal_rests ? formal_idle : !halves_q[0]));
    assert (starts_q == formal_tick && (!starts_q || formal_since == 0));
    assert (phase_q <= half || !run_q);
    if (!run_q) assert (phase_q == 0 && halves_q == 0);
    if (run_q && burst_q) assert (halves_q >= 14 && formal_selected == (halves_q - 14) * (half + 1) + phase_q
        && formal_since == formal_selected + 1);
    if (run_q) assert (formal_bits == (halves_q - (burst_q ? 14 : 222)) >> 1);
    if (run_q && !burst_q) assert (halves_q >= 222 && formal_selected == (halves_q - 222) * (half + 1) + phase_q);
end
