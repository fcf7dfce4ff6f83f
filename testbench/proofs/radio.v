// Nothing reaches the core but the words of a frame that was whole: since the last silence exactly the
// bytes that its length asks for, the right head and robot, no broken byte, the CRC over all bits of the
// line right, a new sequence number, and the radio in command; then no more words than it has.
// The receiver is left out: it may hear anything, but bits and bytes come only while it hears, and it
// begins to hear only when the line is low (proof "receiver").
localparam FORMAL_RESIDUE = 32'hdebb20e3;
reg formal_hears_before = 0, formal_low_before = 0;
always @(posedge clock) begin
    formal_hears_before <= receiver_hearing;
    formal_low_before <= !receiver_level;
end
always @(*) begin
    assume (!receiver_hearing || formal_hears_before || formal_low_before);
    assume (!(receiver_byte_done || receiver_broken || receiver_data_bit) || receiver_hearing);
    assume ({1'b0, receiver_byte_done} + receiver_broken + receiver_data_bit <= 1);
end

// What the line said since the last silence, kept apart from the block.
reg [31:0] formal_crc = 0;
reg [9:0] formal_bytes = 0;
reg [7:0] formal_length = 0, formal_sequence = 0, formal_last = 8'hff;
reg formal_wrong = 1;
wire formal_whole = !formal_wrong && formal_bytes == 8 + 5 * formal_length && formal_crc == FORMAL_RESIDUE;
wire [7:0] formal_ahead = formal_sequence - formal_last;
wire formal_new = formal_ahead != 0 && !(armed && formal_ahead >= 128);
wire formal_begins = playing_d && !playing_q;
integer formal_bit;
always @(posedge clock) begin
    if (silent) formal_crc <= 32'hffffffff;
    else if (receiver_data_bit)
        formal_crc <= (formal_crc >> 1) ^ (formal_crc[0] != receiver_level ? 32'hedb88320 : 32'h0);
    if (boundary) begin
        formal_wrong <= accepts && commands_q;
        formal_bytes <= 0;
    end else if (receiver_broken) formal_wrong <= 1;
    else if (receiver_byte_done) begin
        if (!(&formal_bytes)) formal_bytes <= formal_bytes + 1;
        if (formal_bytes == 0 && receiver_value != 8'ha1) formal_wrong <= 1;
        if (formal_bytes == 1 && receiver_value != robot_number_q) formal_wrong <= 1;
        if (formal_bytes == 2) begin
            formal_length <= receiver_value;
            if (receiver_value == 0 || receiver_value > 95) formal_wrong <= 1;
        end
        if (formal_bytes == 3) formal_sequence <= receiver_value;
        if (formal_bytes > 3 && formal_bytes == 8 + 5 * formal_length) formal_wrong <= 1;
    end
    if (accepts) formal_last <= formal_sequence;
end

// A clock ago.
reg [31:0] formal_crc_before = 0;
reg [7:0] formal_ahead_before = 0;
reg formal_silent_before = 0;
always @(posedge clock) begin
    formal_crc_before <= formal_crc;
    formal_ahead_before <= number_q - last_number_q;
    formal_silent_before <= silent;
end

reg [6:0] formal_words = 0;  // of the frame that acts, not yet taken
reg formal_stands = 0;       // the word offered was not taken at the last edge
reg [39:0] formal_word;
always @(posedge clock) begin
    if (formal_begins) formal_words <= formal_length[6:0];
    else if (offer && taken) formal_words <= formal_words - 1;
    formal_stands <= offer && !taken;
    formal_word <= {code_q, data};
end

always @(*) begin
    if (formal_begins) assert (formal_whole && formal_new && commands_q && silent);
    if (accepts) assert (formal_whole && formal_new);
    if (offer) assert (formal_words != 0);
    if (formal_stands) assert (offer && {code_q, data} == formal_word);
    if (offer) assert (address < 14'h200 && (address < 14'h40 || address >= 14'h100));
    // Invariants that carry the induction.
    assert (quiet_q <= gap);
    assert (check_state == formal_crc);
    assert (check_right_q == (formal_crc_before == FORMAL_RESIDUE));
    assert (ahead_q == formal_ahead_before);
    if (silent && !formal_silent_before) assert (formal_crc == formal_crc_before);
    if (formal_silent_before && listening_q) assert (stage_q == at_head);
    if (listening_q && stage_q >= at_crc) assert (ahead_q == formal_ahead);
    if (receiver_hearing) assert (quiet_q == 0);
    if (formal_hears_before || formal_low_before) assert (quiet_q == 0);
    assert (formal_last == last_number_q);
    if (offer) assert (playing_q);
    if (playing_q) assert (formal_words == total_q - count_q + 1 && formal_words != 0 && !listening_q);
    if (playing_q) assert (count_q >= 1 && count_q <= total_q && total_q <= 95);
    assert (listening_q == !formal_wrong);
    if (!listening_q) assert (stage_q == at_head);
    if (listening_q) begin
        assert (stage_q <= at_end);
        if (stage_q == at_head) assert (formal_bytes == 0);
        if (stage_q == at_robot) assert (formal_bytes == 1);
        if (stage_q == at_length) assert (formal_bytes == 2);
        if (stage_q >= at_sequence) assert (total_q == formal_length && formal_length >= 1 && formal_length <= 95);
        if (stage_q == at_sequence) assert (formal_bytes == 3 && count_q == 1 && inner_q == 0);
        if (stage_q >= at_payload) assert (number_q == formal_sequence);
        if (stage_q == at_payload)
            assert (inner_q <= 4 && count_q >= 1 && count_q <= total_q
                && formal_bytes == 4 + 5 * (count_q - 1) + inner_q);
        if (stage_q == at_crc) assert (inner_q <= 3 && formal_bytes == 4 + 5 * total_q + inner_q);
        if (stage_q == at_end) assert (formal_bytes == 8 + 5 * total_q);
    end
end
