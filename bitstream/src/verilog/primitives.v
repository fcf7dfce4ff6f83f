
// 4,096 bits of memory with two ports. A write shows at the port's own output; the other port reads what was there.
module xc2s200_block_ram #(
    parameter WIDTH_A = 16,
    parameter WIDTH_B = 16,
    parameter [4095:0] CONTENTS = 4096'b0
) (
    input clk_a, input en_a, input we_a, input rst_a, input [11:0] addr_a, input [15:0] di_a, output reg [15:0] do_a,
    input clk_b, input en_b, input we_b, input rst_b, input [11:0] addr_b, input [15:0] di_b, output reg [15:0] do_b
);
    reg [4095:0] bits;
    // Address pins are used from the top: the pins of a word's own bits are tied to 0.
    wire [WIDTH_A-1:0] word_a = bits[addr_a +: WIDTH_A];
    wire [WIDTH_B-1:0] word_b = bits[addr_b +: WIDTH_B];
    initial begin
        bits = CONTENTS;
        do_a = 16'b0;
        do_b = 16'b0;
    end
    always @(posedge clk_a) if (en_a) begin
        if (we_a) bits[addr_a +: WIDTH_A] <= di_a[WIDTH_A-1:0];
        if (rst_a) do_a <= 16'b0;
        else if (we_a) do_a <= {16'b0, di_a[WIDTH_A-1:0]};
        else do_a <= {16'b0, word_a};
    end
    always @(posedge clk_b) if (en_b) begin
        if (we_b) bits[addr_b +: WIDTH_B] <= di_b[WIDTH_B-1:0];
        if (rst_b) do_b <= 16'b0;
        else if (we_b) do_b <= {16'b0, di_b[WIDTH_B-1:0]};
        else do_b <= {16'b0, word_b};
    end
endmodule
