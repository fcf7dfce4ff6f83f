// Addition and subtraction clamp and never wrap, for every pair of 31-bit values; a word that the
// program stores goes where the instruction says, and a write of the bus is taken or told to wait. A bus that
// reads a word in the clock in which it is written gets what is written, not what the memory shows then.
localparam signed [33:0] FORMAL_MAX = 34'sh1FFFFFFF;
localparam signed [33:0] FORMAL_MIN = -34'sh20000000;
wire signed [33:0] formal_a = $signed(accumulator_q);
wire signed [33:0] formal_b = $signed(word);
wire signed [33:0] formal_exact = subtracting ? formal_a - formal_b : formal_a + formal_b;
wire formal_narrow = accumulator_q[31] == accumulator_q[30] && word[31] == word[30];
reg formal_meets = 0;
reg [31:0] formal_written;
always @(posedge clock) begin
    formal_meets <= memory_write_enable && memory_write_address == bus_address;
    formal_written <= memory_write_data;
end

always @(*) begin
    if (formal_meets) assert (bus_read_data == formal_written);
    else assert (bus_read_data == mirror_read_data);
    if (formal_narrow) assert ($signed(saturated)
        == (formal_exact > FORMAL_MAX ? FORMAL_MAX : formal_exact < FORMAL_MIN ? FORMAL_MIN : formal_exact));
    if (valid_q && op == 3) assert (!subtracting && accumulator_d == saturated);
    if (valid_q && op == 4) assert (subtracting && accumulator_d == saturated);
    if (bus_write) assert (bus_write_taken == !bus_blocked);
    if (bus_write_taken) assert (memory_write_enable && memory_write_address == bus_address);
    if (storing) assert (bus_blocked && memory_write_data == accumulator_q);
end
