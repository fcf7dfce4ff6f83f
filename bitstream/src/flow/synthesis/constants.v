// What abc was not to know (compare.v).
module VCC (output P);
    assign P = 1;
endmodule
module GND (output G);
    assign G = 0;
endmodule
