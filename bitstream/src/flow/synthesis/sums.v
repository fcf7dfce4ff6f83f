// Sums. What is short goes to tables: its bits are functions of few inputs, into which the logic behind them goes. Else a carry
// chain, whose data pin is the operand that is constant, if one is, or the first. Below the lowest bit that decides anything
// no chain is needed: a counter's bit 0 only turns, and is itself the carry into bit 1.
(* techmap_celltype = "$alu" *)
module sum (A, B, CI, BI, X, Y, CO);
    parameter A_SIGNED = 0;
    parameter B_SIGNED = 0;
    parameter A_WIDTH = 1;
    parameter B_WIDTH = 1;
    parameter Y_WIDTH = 1;
    parameter _TECHMAP_CONSTMSK_A_ = 0;
    parameter _TECHMAP_CONSTVAL_A_ = 0;
    parameter _TECHMAP_CONSTMSK_B_ = 0;
    parameter _TECHMAP_CONSTVAL_B_ = 0;
    parameter _TECHMAP_CONSTMSK_BI_ = 0;
    parameter _TECHMAP_CONSTVAL_BI_ = 0;
    parameter _TECHMAP_CONSTMSK_CI_ = 0;
    parameter _TECHMAP_CONSTVAL_CI_ = 0;
    (* force_downto *) input [A_WIDTH-1:0] A;
    (* force_downto *) input [B_WIDTH-1:0] B;
    (* force_downto *) output [Y_WIDTH-1:0] X, Y, CO;
    input CI, BI;
    (* force_downto *) wire [Y_WIDTH-1:0] left, right;
    \$pos #(.A_SIGNED(A_SIGNED), .A_WIDTH(A_WIDTH), .Y_WIDTH(Y_WIDTH)) widen_a (.A(A), .Y(left));
    \$pos #(.A_SIGNED(B_SIGNED), .A_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) widen_b (.A(B), .Y(right));
    wire [Y_WIDTH-1:0] added = right ^ {Y_WIDTH{BI}};

    // Bits of each operand that are constant, and which; above its own bits it is 0, or unknown if it has a sign.
    localparam [Y_WIDTH-1:0] OWN_A = (1 << A_WIDTH) - 1;
    localparam [Y_WIDTH-1:0] OWN_B = (1 << B_WIDTH) - 1;
    localparam [Y_WIDTH-1:0] FIXED_A = (_TECHMAP_CONSTMSK_A_ & OWN_A) | (A_SIGNED ? 0 : ~OWN_A);
    localparam [Y_WIDTH-1:0] FIXED_B =
        _TECHMAP_CONSTMSK_BI_ ? (_TECHMAP_CONSTMSK_B_ & OWN_B) | (B_SIGNED ? 0 : ~OWN_B) : 0;
    localparam [Y_WIDTH-1:0] FIXED = FIXED_A | FIXED_B;
    localparam [Y_WIDTH-1:0] VALUE = (FIXED_A & _TECHMAP_CONSTVAL_A_ & OWN_A)
        | (~FIXED_A & FIXED_B & ((_TECHMAP_CONSTVAL_B_ & OWN_B) ^ {Y_WIDTH{_TECHMAP_CONSTVAL_BI_ == 1}}));
    // How many bits have a constant carry in: those before and with the first whose constant is not the carry.
    function [31:0] idle(input [31:0] unused);
        integer at;
        reg going;
        begin
            idle = 0;
            going = _TECHMAP_CONSTMSK_CI_;
            for (at = 0; at < Y_WIDTH; at = at + 1)
                if (going && FIXED[at]) begin
                    idle = at + 1;
                    if (VALUE[at] != _TECHMAP_CONSTVAL_CI_) going = 0;
                end else
                    going = 0;
        end
    endfunction
    localparam IDLE = idle(0);

    wire [Y_WIDTH:0] carry;
    assign carry[0] = CI;
    genvar i;
    generate for (i = 0; i < Y_WIDTH; i = i + 1)
        if (i < IDLE || Y_WIDTH - IDLE <= `TABLES) begin
            assign carry[i + 1] = left[i] & added[i] | (left[i] | added[i]) & carry[i];
            assign Y[i] = X[i] ^ carry[i];
        end else begin
            MUXCY muxcy (.CI(carry[i]), .DI(FIXED[i] ? VALUE[i] : left[i]), .S(X[i]), .O(carry[i + 1]));
            XORCY sum (.CI(carry[i]), .LI(X[i]), .O(Y[i]));
        end
    endgenerate
    assign X = left ^ added;
    assign CO = carry[Y_WIDTH:1];
endmodule
