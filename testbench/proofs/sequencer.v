// Addition and subtraction clamp and never wrap, for every pair of 31-bit values; a word that the
// program stores goes where the instruction says, and a write of the bus is taken or told to wait. A bus that
// reads a word in the clock in which it is written gets what is written, not what the memory shows then.
localparam signed [33:0] FORMAL_MAX = 34'sh1FFFFFFF;
localparam signed [33:0] FORMAL_MIN = -34'sh20000000;
wire signed [33:0] formal_a = $signed(accumulator_q);
wire signed [33:0] formal_b = $signed(word);
wire signed [33:0] formal_exact = subtracting ? formal_a - formal_b : formal_a + formal_b;
wire formal_narrow = accumulator_q[31] == accumulator_q[30] && word[31] == word[30];
// The sum stands a clock later, and is the accumulator's after that clock, unless the instruction there loads it.
reg formal_meets = 0, formal_was_narrow = 0;
reg signed [33:0] formal_was;
wire formal_loads = valid_q && (op == 1 || op == 2 || op == 9 || op == 10 || op == 12 || op == 22 || op == 23);
reg [31:0] formal_written;
reg formal_blocked = 0;
always @(posedge clock) begin
    formal_meets <= memory_write_enable && memory_write_address == bus_address;
    formal_written <= memory_write_data;
    formal_blocked <= bus_blocked;
    formal_was_narrow <= formal_narrow;
    formal_was <= formal_exact;
end

always @(*) begin
    if (formal_meets) assert (bus_read_data == formal_written);
    else assert (bus_read_data == mirror_read_data);
    if (formal_was_narrow) assert ($signed(saturated)
        == (formal_was > FORMAL_MAX ? FORMAL_MAX : formal_was < FORMAL_MIN ? FORMAL_MIN : formal_was));
    assert (finishing_q + saturates_q + cuts_16_q + cuts_24_q <= 3'd1);
    if (saturates_q && !formal_loads) assert (accumulator_d == saturated);
    if (valid_q && op == 3) assert (!subtracting && saturates_d);
    if (valid_q && op == 4) assert (subtracting && saturates_d);
    // Proof "gate".
    assume (!(bus_write && formal_blocked));
    if (bus_write) assert (memory_write_enable && memory_write_address == bus_write_address
        && memory_write_data == bus_write_data);
    assert (storing_q == formal_blocked);
    if (storing_q) assert (memory_write_enable && memory_write_address == store_address_q
        && memory_write_data == accumulator_q);
end
