// A counter's next value, or the word that it is loaded with: one table a bit. The table chooses, and while it loads the carry
// into the chain lies so that no bit turns: 0 where carries count up, 1 where they count down, inverted.
module loaded_counter #(parameter WIDTH = 1, parameter DOWN = 0) (
    input [WIDTH-1:0] Q, D, input load, output [WIDTH-1:0] Y
);
    wire [WIDTH-1:0] half = (load ? D : Q) ^ {WIDTH{DOWN == 1}};
    wire [WIDTH:0] carry;
    assign carry[0] = load ^ (DOWN == 0);
    genvar i;
    generate for (i = 0; i < WIDTH; i = i + 1) begin
        if (i < WIDTH - 1) MUXCY muxcy (.CI(carry[i]), .DI(DOWN == 1), .S(half[i]), .O(carry[i + 1]));
        XORCY sum (.LI(half[i]), .CI(carry[i]), .O(Y[i]));
    end endgenerate
endmodule
