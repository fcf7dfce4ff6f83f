/* Registers of rac4i65, map version 2.1: byte offsets in BAR 5. Do not edit; see registers.md. */
#ifndef RAC4I65_REGISTERS_H
#define RAC4I65_REGISTERS_H

#define RAC4I65_MAP_VERSION 0x00020001u

#define RAC4I65_COOKIE 0x000u /* "RAC4": this is the design */
#define RAC4I65_MAP_VERSION 0x004u /* version of this map, major in bits 31:16 */
#define RAC4I65_BOARD 0x008u /* board whose pins the bitstream drives; a 5I20 has the same FPGA on other pins */
#define RAC4I65_CLOCK_HZ 0x00cu /* nominal clock in Hz; the real one is measured with `time` */
#define RAC4I65_CONTENT_HASH 0x010u /* hash of the emitted Verilog with this constant zeroed; the reset value is the one in `rac4i65.v` */
#define RAC4I65_AXIS_COUNT 0x014u /* axes of the core */
#define RAC4I65_TIME 0x018u /* clocks since configuration, wrapping */
#define RAC4I65_BLOCKS 0x01cu /* block list: what the design holds, and how many of each */
#define RAC4I65_BLOCKS_ENCODERS 0x0000000fu /* quadrature counters with index capture and stall detection */
#define RAC4I65_BLOCKS_DRIVES 0x000000f0u /* PWM generators */
#define RAC4I65_BLOCKS_LOOPS 0x00000f00u /* PI speed loops with feed-forward */
#define RAC4I65_BLOCKS_COUNT_AND_TIME 0x00001000u /* speed by count and time */
#define RAC4I65_BLOCKS_INVERSE_KINEMATICS 0x00002000u /* body velocity to wheel speeds */
#define RAC4I65_BLOCKS_ODOMETRY 0x00004000u /* pose */
#define RAC4I65_BLOCKS_KICKER 0x00008000u /* kicker */
#define RAC4I65_BLOCKS_SNAPSHOT 0x00010000u /* coherent snapshots */
#define RAC4I65_BLOCKS_CLOCK_MONITOR 0x00020000u /* monitor on the 50 MHz crystal */
#define RAC4I65_BLOCKS_INTERRUPT 0x00040000u /* control-tick interrupt */
#define RAC4I65_BLOCKS_RADIO 0x00080000u /* radio input */
#define RAC4I65_TICK_PERIOD 0x020u /* control period in clocks, at least 1000 */
#define RAC4I65_MODE 0x024u /* speed measurement, kind of set points, odometry, kind of PWM */
#define RAC4I65_MODE_COUNT_AND_TIME 0x00000001u /* 1: speed by count and time (M/T); 0: count difference per tick */
#define RAC4I65_MODE_TWIST 0x00000002u /* 1: set points are a body velocity, inverse kinematics in gateware; 0: wheel speeds */
#define RAC4I65_MODE_ODOMETRY 0x00000004u /* 1: a pose is kept from the encoders at every tick; 0: bypassed, the pose is zero */
#define RAC4I65_MODE_UP_DOWN 0x00000008u /* 1: PWM pin pulses forward, DIR pin backward, never both; 0: magnitude on PWM, sign on DIR */
#define RAC4I65_ENCODER_FILTER 0x028u /* an encoder line must be stable for so many clocks and one more */
#define RAC4I65_PWM_PERIOD 0x02cu /* PWM period in clocks; 0 is off */
#define RAC4I65_PWM_BLANKING 0x030u /* clocks with PWM low before and after a change of DIR */
#define RAC4I65_WATCHDOG_TIMEOUT 0x034u /* clocks without a valid set-point commit until the outputs go off; 0 never lets them on */
#define RAC4I65_ARM 0x038u /* "ARM1" then "ARM2" arms, unless a fault stands; anything else disarms at once */
#define RAC4I65_FAULTS 0x03cu /* sticky faults; writing anything but 0 clears those whose cause is gone */
#define RAC4I65_FAULTS_WATCHDOG 0x00000001u /* no valid set-point commit for `watchdog_timeout` */
#define RAC4I65_FAULTS_EMERGENCY_STOP 0x00000002u /* emergency stop input high or open */
#define RAC4I65_FAULTS_ENCODER 0x00000004u /* an encoder of `encoder_fault_mask` saw an illegal transition */
#define RAC4I65_FAULTS_COMMIT 0x00000008u /* a commit had the wrong checksum or number of words; nothing changed */
#define RAC4I65_FAULTS_EXTERNAL 0x00000010u /* another block asked to stop */
#define RAC4I65_FAULTS_ARM_REFUSED 0x00000020u /* arming was tried while a fault stood, or out of sequence */
#define RAC4I65_FAULTS_STALL 0x00000040u /* an axis of `encoder_fault_mask` was driven and did not move: see `stall` */
#define RAC4I65_FIRST_FAULT 0x040u /* the fault that came first since the last clear */
#define RAC4I65_FIRST_FAULT_WATCHDOG 0x00000001u /* no valid set-point commit for `watchdog_timeout` */
#define RAC4I65_FIRST_FAULT_EMERGENCY_STOP 0x00000002u /* emergency stop input high or open */
#define RAC4I65_FIRST_FAULT_ENCODER 0x00000004u /* an encoder of `encoder_fault_mask` saw an illegal transition */
#define RAC4I65_FIRST_FAULT_COMMIT 0x00000008u /* a commit had the wrong checksum or number of words; nothing changed */
#define RAC4I65_FIRST_FAULT_EXTERNAL 0x00000010u /* another block asked to stop */
#define RAC4I65_FIRST_FAULT_ARM_REFUSED 0x00000020u /* arming was tried while a fault stood, or out of sequence */
#define RAC4I65_FIRST_FAULT_STALL 0x00000040u /* an axis of `encoder_fault_mask` was driven and did not move: see `stall` */
#define RAC4I65_STATUS 0x044u /* live state */
#define RAC4I65_STATUS_ARMED 0x00000001u /* outputs may be on */
#define RAC4I65_STATUS_SET_POINTS_VALID 0x00000002u /* a set point was committed since arming and has not timed out */
#define RAC4I65_STATUS_EMERGENCY_STOP 0x00000004u /* emergency stop input, live */
#define RAC4I65_STATUS_BALL 0x00000008u /* ball sensor, live */
#define RAC4I65_STATUS_SET_POINTS_PENDING 0x00000010u /* a commit of set points waits for the next tick */
#define RAC4I65_STATUS_CONFIGURATION_PENDING 0x00000020u /* a commit of the configuration waits for the next tick */
#define RAC4I65_COMMIT_SET_POINTS 0x048u /* checksum over the staged set points; a right one pets the watchdog */
#define RAC4I65_COMMIT_CONFIGURATION 0x04cu /* checksum over the staged configuration */
#define RAC4I65_COMMITS 0x050u /* commits since configuration, wrapping */
#define RAC4I65_COMMITS_ACCEPTED 0x0000ffffu /* commits with the right checksum and number of words */
#define RAC4I65_COMMITS_REJECTED 0xffff0000u /* commits that changed nothing */
#define RAC4I65_ENCODER_ERROR 0x054u /* per axis: both lines changed at once */
#define RAC4I65_ENCODER_LINES 0x058u /* filtered lines, A of axis i in bit 2i, B in bit 2i + 1, index in bit 8 + i */
#define RAC4I65_ENCODER_FAULT_MASK 0x05cu /* axes whose encoder error disarms */
#define RAC4I65_KICKER_CONTROL 0x060u /* charging, discharging and automatic trigger */
#define RAC4I65_KICKER_CONTROL_CHARGE 0x00000001u /* charge the capacitor, until the time-out */
#define RAC4I65_KICKER_CONTROL_ARM_ON_BALL 0x00000002u /* fire when the ball sensor sees the ball */
#define RAC4I65_KICKER_CONTROL_HOLD 0x00000004u /* keep the charge while disarmed; an emergency stop or a dead clock discharges all the same */
#define RAC4I65_KICKER_CONTROL_BY_TIME 0x00000008u /* 1: charge until the time-out whatever `kicker_full` says; 0: stop charging while it is high */
#define RAC4I65_KICKER_FIRE 0x064u /* "KICK" fires, when armed and not locked out */
#define RAC4I65_KICKER_PULSE 0x068u /* trigger pulse in microseconds; longer than 10000 acts as 10000 */
#define RAC4I65_KICKER_LOCKOUT 0x06cu /* microseconds after a pulse in which none can follow; a hard minimum is in the gateware */
#define RAC4I65_KICKER_CHARGE_TIMEOUT 0x070u /* microseconds after which charging stops; 0 never charges */
#define RAC4I65_KICKER_STATUS 0x074u /* state of the kicker; a write to `faults` clears its flags */
#define RAC4I65_KICKER_STATUS_STATE 0x00000007u /* see the kicker's page */
#define RAC4I65_KICKER_STATUS_READY 0x00000010u /* a fire request would be taken */
#define RAC4I65_KICKER_STATUS_CHARGE_TIMED_OUT 0x00000020u /* charging took longer than its time-out */
#define RAC4I65_KICKER_STATUS_FIRE_DROPPED 0x00000040u /* a fire request came while disarmed or locked out */
#define RAC4I65_KICKER_STATUS_FULL 0x00000080u /* the filtered input for a full capacitor; high or open = full */
#define RAC4I65_CLOCKS_PER_US 0x078u /* clocks in what the kicker takes for a microsecond; below 25 acts as 25, above 34 as 34 */
#define RAC4I65_LEDS 0x07cu /* the eight LEDs, 1 = on */
#define RAC4I65_SET_POINT_TIMEOUT 0x080u /* control ticks after which a set point is zero until the next commit; the watchdog disarms later */
#define RAC4I65_STALL_WINDOW 0x084u /* control ticks in which a driven wheel must move 4 counts net */
#define RAC4I65_STALL_COMPARE 0x088u /* PWM clocks above which a wheel counts as driven; 8191 switches the stall detection off */
#define RAC4I65_STALL 0x08cu /* per axis: driven through a whole window without net counts; a broken wire, or a blocked wheel */
#define RAC4I65_INDEX_ARM 0x090u /* axes whose next index is captured, and how; all others are left alone */
#define RAC4I65_INDEX_ARM_LATCH 0x0000000fu /* per axis: latch the position at the next rising index */
#define RAC4I65_INDEX_ARM_CLEAR 0x000000f0u /* per axis with its latch bit: counts begin at zero there */
#define RAC4I65_INDEX_STATUS 0x094u /* state of the index capture */
#define RAC4I65_INDEX_STATUS_WAITING 0x0000000fu /* per axis: armed, no index yet */
#define RAC4I65_INDEX_STATUS_SEEN 0x000000f0u /* per axis: captured; `index_position` is there after the next control tick */
#define RAC4I65_INTERRUPT_ENABLE 0x098u /* causes that pull INT# low; none after configuration */
#define RAC4I65_INTERRUPT_ENABLE_TICK 0x00000001u /* a control tick has ended: its snapshot is there */
#define RAC4I65_INTERRUPT_ENABLE_DISARMED 0x00000002u /* the outputs went off, by a fault or by the host */
#define RAC4I65_INTERRUPT_STATUS 0x09cu /* causes since they were cleared, enabled or not; INT# is low while an enabled one is set */
#define RAC4I65_INTERRUPT_STATUS_TICK 0x00000001u /* a control tick has ended: its snapshot is there */
#define RAC4I65_INTERRUPT_STATUS_DISARMED 0x00000002u /* the outputs went off, by a fault or by the host */
#define RAC4I65_RADIO 0x0a0u /* who commands, and counters of the link, which cannot be written and wrap */
#define RAC4I65_RADIO_SELECT 0x00000001u /* 1: commands come in the radio's frames, and a host's writes reach only `arm` and this register; 0: from the host; after configuration 1 where the strap `host_select` is low */
#define RAC4I65_RADIO_ACCEPTED 0x0000ff00u /* frames that were whole and new, whoever commands */
#define RAC4I65_RADIO_DROPPED 0x00ff0000u /* frames with a wrong CRC, length or version, cut short, run over, or repeated; not those for other robots */
#define RAC4I65_CONFIGURATION 0x400u /* staged configuration bank: ten groups of one word per axis */
#define RAC4I65_CONFIGURATION_WORDS 52u
#define RAC4I65_ACTIVE_CONFIGURATION 0x500u /* configuration in force */
#define RAC4I65_ACTIVE_CONFIGURATION_WORDS 52u
#define RAC4I65_SET_POINTS 0x600u /* staged set points: wheel speeds, or body velocity x, y, rotation and a spare */
#define RAC4I65_SET_POINTS_WORDS 4u
#define RAC4I65_ACTIVE_SET_POINTS 0x640u /* set points in force */
#define RAC4I65_ACTIVE_SET_POINTS_WORDS 4u
#define RAC4I65_INDEX_POSITION 0x770u /* counts at the last captured index, in the frame before it was cleared, two's complement */
#define RAC4I65_INDEX_POSITION_WORDS 4u
#define RAC4I65_INTEGRALS 0x790u /* integrators of the speed loops; not part of a snapshot */
#define RAC4I65_INTEGRALS_WORDS 4u
#define RAC4I65_SNAPSHOT_SEQUENCE 0x800u /* number of control ticks; reading it latches the snapshot */
#define RAC4I65_SNAPSHOT_STATUS 0x804u /* `status` at the tick, without what is pending */
#define RAC4I65_SNAPSHOT_STATUS_ARMED 0x00000001u /* outputs may be on */
#define RAC4I65_SNAPSHOT_STATUS_SET_POINTS_VALID 0x00000002u /* a set point was committed since arming and has not timed out */
#define RAC4I65_SNAPSHOT_STATUS_EMERGENCY_STOP 0x00000004u /* emergency stop input, live */
#define RAC4I65_SNAPSHOT_STATUS_BALL 0x00000008u /* ball sensor, live */
#define RAC4I65_SNAPSHOT_STATUS_SET_POINTS_PENDING 0x00000010u /* a commit of set points waits for the next tick */
#define RAC4I65_SNAPSHOT_STATUS_CONFIGURATION_PENDING 0x00000020u /* a commit of the configuration waits for the next tick */
#define RAC4I65_SNAPSHOT_TIME 0x808u /* low 24 bits of `time` at the tick */
#define RAC4I65_SNAPSHOT_FAULTS 0x80cu /* `faults` at the tick */
#define RAC4I65_SNAPSHOT_FAULTS_WATCHDOG 0x00000001u /* no valid set-point commit for `watchdog_timeout` */
#define RAC4I65_SNAPSHOT_FAULTS_EMERGENCY_STOP 0x00000002u /* emergency stop input high or open */
#define RAC4I65_SNAPSHOT_FAULTS_ENCODER 0x00000004u /* an encoder of `encoder_fault_mask` saw an illegal transition */
#define RAC4I65_SNAPSHOT_FAULTS_COMMIT 0x00000008u /* a commit had the wrong checksum or number of words; nothing changed */
#define RAC4I65_SNAPSHOT_FAULTS_EXTERNAL 0x00000010u /* another block asked to stop */
#define RAC4I65_SNAPSHOT_FAULTS_ARM_REFUSED 0x00000020u /* arming was tried while a fault stood, or out of sequence */
#define RAC4I65_SNAPSHOT_FAULTS_STALL 0x00000040u /* an axis of `encoder_fault_mask` was driven and did not move: see `stall` */
#define RAC4I65_SNAPSHOT_COUNT 0x810u /* encoder counts, wrapping two's complement */
#define RAC4I65_SNAPSHOT_COUNT_WORDS 4u
#define RAC4I65_SNAPSHOT_SPEED 0x820u /* measured speed in counts per clock */
#define RAC4I65_SNAPSHOT_SPEED_WORDS 4u
#define RAC4I65_SNAPSHOT_REFERENCE 0x830u /* speed set point in force in counts per clock */
#define RAC4I65_SNAPSHOT_REFERENCE_WORDS 4u
#define RAC4I65_SNAPSHOT_DUTY 0x840u /* duty, 1 = full drive */
#define RAC4I65_SNAPSHOT_DUTY_WORDS 4u
#define RAC4I65_SNAPSHOT_POSE 0x850u /* pose x, y in the driver's unit, heading in 2^-32 turn; two's complement, wrapping */
#define RAC4I65_SNAPSHOT_POSE_WORDS 3u
#define RAC4I65_SNAPSHOT_SEQUENCE_END 0x85cu /* equals `snapshot_sequence` in a coherent snapshot; reading it releases the latch */

#endif
