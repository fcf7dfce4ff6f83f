// Magnitude comparisons. Two long words: a bit a table on one carry chain, whose data pin is one of the table's own inputs; yosys'
// own map looks at two bits a table, and then its generate and the chain's bit take a table each as well. What
// is short, or against a constant, is left to tables, which swallow constants whole.
(* techmap_celltype = "$lt $le $gt $ge" *)
module compare (A, B, Y);
    parameter A_SIGNED = 0;
    parameter B_SIGNED = 0;
    parameter A_WIDTH = 1;
    parameter B_WIDTH = 1;
    parameter Y_WIDTH = 1;
    parameter _TECHMAP_CELLTYPE_ = "";
    parameter _TECHMAP_CONSTMSK_A_ = 0;
    parameter _TECHMAP_CONSTMSK_B_ = 0;
    (* force_downto *) input [A_WIDTH-1:0] A;
    (* force_downto *) input [B_WIDTH-1:0] B;
    (* force_downto *) output [Y_WIDTH-1:0] Y;
    wire _TECHMAP_FAIL_ = A_SIGNED || B_SIGNED;
    localparam WIDTH = A_WIDTH > B_WIDTH ? A_WIDTH : B_WIDTH;
    localparam SHARED = A_WIDTH > B_WIDTH ? B_WIDTH : A_WIDTH;
    localparam SWAPPED = _TECHMAP_CELLTYPE_ == "$lt" || _TECHMAP_CELLTYPE_ == "$le";
    localparam STRICT = _TECHMAP_CELLTYPE_ == "$lt" || _TECHMAP_CELLTYPE_ == "$gt";
    localparam [WIDTH-1:0] FIXED =
        _TECHMAP_CONSTMSK_A_ | _TECHMAP_CONSTMSK_B_ | ~((1 << A_WIDTH) - 1) | ~((1 << B_WIDTH) - 1);
    wire [WIDTH-1:0] left = A, right = B;
    wire [WIDTH-1:0] more = SWAPPED ? right : left;
    wire [WIDTH-1:0] less = SWAPPED ? left : right;
    wire [WIDTH:0] so_far;
    assign so_far[0] = !STRICT;
    genvar i;
    generate for (i = 0; i < WIDTH; i = i + 1) begin
        if (SHARED > `TABLES && !FIXED[i])
            MUXCY carry (.CI(so_far[i]), .DI(more[i]), .S(~(more[i] ^ less[i])), .O(so_far[i + 1]));
        else
            assign so_far[i + 1] = (more[i] & ~less[i]) | ((more[i] | ~less[i]) & so_far[i]);
    end endgenerate
    // abc takes a chain's answer as ready at once. Each of these gates is a table to it, for it does not know that the pins beside
    // are constants; once it has mapped, they become such (constants.v), and the gate is a wire.
    localparam LEVELS = SHARED > `SOON ? `LEVELS : 0;
    wire [LEVELS:0] later;
    assign later[0] = so_far[WIDTH];
    generate for (i = 0; i < LEVELS; i = i + 1) begin
        wire high, low;
        VCC one (.P(high));
        GND zero (.G(low));
        assign later[i + 1] = high & low | (high | low) & later[i];
    end endgenerate
    assign Y = later[LEVELS];
endmodule
