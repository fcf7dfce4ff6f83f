// Set points and configuration act all at once, at a tick, and only with the right checksum and the
// right number of words: a bank changes only at a tick that follows an accepted commit, with no word
// staged in between, not even in the clock of the tick.
localparam FORMAL_WORDS = 52;
reg formal_running = 0, formal_tick, formal_stage_set_point, formal_stage_configuration;
reg formal_set_point_bank, formal_configuration_bank;
reg formal_set_points = 0, formal_configuration = 0;  // accepted, and nothing staged since
reg formal_set_points_then, formal_configuration_then;
reg [31:0] formal_sum = 32'h52414353;
reg [6:0] formal_staged_set_points = 0, formal_staged_configuration = 0;
reg formal_right = 0, formal_come_set_points = 0, formal_come_configuration = 0;  // of the commit a clock before
wire formal_accept_set_points =
    formal_come_set_points && formal_right && formal_staged_set_points == 4 && formal_staged_configuration == 0;
wire formal_accept_configuration =
    formal_come_configuration && formal_right && formal_staged_configuration == FORMAL_WORDS && formal_staged_set_points == 0;

always @(posedge clock) begin
    formal_running <= 1;
    formal_right <= checksum == formal_sum;
    formal_come_set_points <= commit_set_points;
    formal_come_configuration <= commit_configuration;
    formal_tick <= tick;
    formal_stage_set_point <= stage_set_point;
    formal_stage_configuration <= stage_configuration;
    formal_set_point_bank <= set_point_bank;
    formal_configuration_bank <= configuration_bank;
    formal_set_points_then <= formal_set_points;
    formal_configuration_then <= formal_configuration;
    formal_set_points <= formal_accept_set_points || (formal_set_points && !tick && !stage_set_point);
    formal_configuration <= formal_accept_configuration || (formal_configuration && !tick && !stage_configuration);
    if (formal_come_set_points || formal_come_configuration) begin
        formal_sum <= 32'h52414353;
        formal_staged_set_points <= 0;
        formal_staged_configuration <= 0;
    end else if (stage_set_point || stage_configuration) begin
        formal_sum <= {formal_sum[30:0], formal_sum[31]} ^ data ^ address;
        if (stage_set_point && formal_staged_set_points != 63)
            formal_staged_set_points <= formal_staged_set_points + 1;
        if (stage_configuration && formal_staged_configuration != 63)
            formal_staged_configuration <= formal_staged_configuration + 1;
    end
end

always @(*) begin
    assume (!(commit_set_points && commit_configuration));
    assume (!(stage_set_point && stage_configuration));
    assume (!((stage_set_point || stage_configuration) && (formal_come_set_points || formal_come_configuration)));
    if (formal_running && set_point_bank != formal_set_point_bank)
        assert (formal_tick && formal_set_points_then && !formal_stage_set_point);
    if (formal_running && configuration_bank != formal_configuration_bank)
        assert (formal_tick && formal_configuration_then && !formal_stage_configuration);
    if (pet) assert (formal_accept_set_points);
    assert (fault == ((formal_come_set_points || formal_come_configuration)
        && !formal_accept_set_points && !formal_accept_configuration));
    // Invariants that carry the induction.
    assert (set_points_wait_q == formal_set_points && configuration_waits_q == formal_configuration);
    assert (sum_q == formal_sum && sum_right_q == formal_right);
    assert (set_points_come_q == formal_come_set_points && configuration_comes_q == formal_come_configuration);
    assert (set_points_q == formal_staged_set_points && configuration_q == formal_staged_configuration);
end
