// Short sums as tables: their bits are functions of few inputs, into which the logic behind them goes.
(* techmap_celltype = "$alu" *)
module short_sum (A, B, CI, BI, X, Y, CO);
    parameter A_SIGNED = 0;
    parameter B_SIGNED = 0;
    parameter A_WIDTH = 1;
    parameter B_WIDTH = 1;
    parameter Y_WIDTH = 1;
    (* force_downto *) input [A_WIDTH-1:0] A;
    (* force_downto *) input [B_WIDTH-1:0] B;
    (* force_downto *) output [Y_WIDTH-1:0] X, Y, CO;
    input CI, BI;
    wire _TECHMAP_FAIL_ = Y_WIDTH > `TABLES;
    (* force_downto *) wire [Y_WIDTH-1:0] left, right;
    \$pos #(.A_SIGNED(A_SIGNED), .A_WIDTH(A_WIDTH), .Y_WIDTH(Y_WIDTH)) widen_a (.A(A), .Y(left));
    \$pos #(.A_SIGNED(B_SIGNED), .A_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) widen_b (.A(B), .Y(right));
    wire [Y_WIDTH-1:0] added = right ^ {Y_WIDTH{BI}};
    wire [Y_WIDTH:0] carry;
    assign carry[0] = CI;
    genvar i;
    generate for (i = 0; i < Y_WIDTH; i = i + 1)
        assign carry[i + 1] = left[i] & added[i] | (left[i] | added[i]) & carry[i];
    endgenerate
    assign X = left ^ added;
    assign Y = X ^ carry[Y_WIDTH-1:0];
    assign CO = carry[Y_WIDTH:1];
endmodule
