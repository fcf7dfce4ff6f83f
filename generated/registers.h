/* Registers of rac4i65, map version 2.3: byte offsets in BAR 5. Do not edit; see registers.md. */
#ifndef RAC4I65_REGISTERS_H
#define RAC4I65_REGISTERS_H

#define RAC4I65_THIS_MAP_VERSION 0x00020003u /* what RAC4I65_MAP_VERSION reads */
#define RAC4I65_CHECKSUM_SEED 0x52414353u /* sum = rotl(sum, 1) ^ data ^ offset / 4, in the order of the writes */
#define RAC4I65_RADIO_HEAD 0xa1u /* first byte of a frame */

#define RAC4I65_COOKIE 0x000u /* "RAC4": this is the design */
#define RAC4I65_MAP_VERSION 0x004u /* version of this map, major in bits 31:16 */
#define RAC4I65_BOARD 0x008u /* board whose pins the bitstream drives; a 5I20 has the same FPGA as a 4I65 on other pins */
#define RAC4I65_BOARD_VALUE_4I65 0x34493635u /* Mesa 4I65 (XC2S200), clocked by its PCI bridge */
#define RAC4I65_BOARD_VALUE_HX8K 0x4858384bu /* Lattice iCE40-HX8K breakout board, clocked by its PLL */
#define RAC4I65_CLOCK_HZ 0x00cu /* nominal clock of that board in Hz, 33000000 on the HX8K; the real one is measured with `time` */
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
#define RAC4I65_BLOCKS_IMU 0x00100000u /* reader of an inertial sensor over SPI */
#define RAC4I65_TICK_PERIOD 0x020u /* control period in clocks, at least 1000 */
#define RAC4I65_MODE 0x024u /* speed measurement, kind of set points, odometry, kind of PWM */
#define RAC4I65_MODE_COUNT_AND_TIME 0x00000001u /* 1: speed by count and time (M/T); 0: count difference per tick */
#define RAC4I65_MODE_TWIST 0x00000002u /* 1: set points are a body velocity, inverse kinematics in gateware; 0: wheel speeds */
#define RAC4I65_MODE_ODOMETRY 0x00000004u /* 1: a pose is kept from the encoders at every tick; 0: bypassed, the pose is zero */
#define RAC4I65_MODE_UP_DOWN 0x00000008u /* 1: PWM pin pulses forward, DIR pin backward, never both; 0: magnitude on PWM, sign on DIR */
#define RAC4I65_ENCODER_FILTER 0x028u /* an encoder line must be stable for so many clocks and one more */
#define RAC4I65_PWM_PERIOD 0x02cu /* PWM period in clocks */
#define RAC4I65_PWM_BLANKING 0x030u /* clocks with PWM low before and after a change of DIR */
#define RAC4I65_WATCHDOG_TIMEOUT 0x034u /* clocks without a valid set-point commit until the outputs go off */
#define RAC4I65_ARM 0x038u /* the first word and then, as the next write to this register, the second arm the card, if from the one to the other no cause of watchdog, emergency-stop, encoder, external or stall stands; bits of `faults` whose cause is gone do not matter, nor do commit and arm-refused; any other word disarms at once */
#define RAC4I65_ARM_VALUE_FIRST 0x41524d31u /* "ARM1": disarms and begins the sequence */
#define RAC4I65_ARM_VALUE_SECOND 0x41524d32u /* "ARM2": arms, as the next write to this register after the first word */
#define RAC4I65_FAULTS 0x03cu /* sticky faults; a fault whose cause stands comes back at once: encoder until `encoder_error` is cleared, stall until `stall` is, watchdog until a commit of set points; after configuration those that power-up is */
#define RAC4I65_FAULTS_WATCHDOG 0x00000001u /* no valid set-point commit for `watchdog_timeout`; disarms */
#define RAC4I65_FAULTS_EMERGENCY_STOP 0x00000002u /* emergency stop input high or open; disarms */
#define RAC4I65_FAULTS_ENCODER 0x00000004u /* an axis of `encoder_fault_mask` has its bit in `encoder_error`; disarms */
#define RAC4I65_FAULTS_COMMIT 0x00000008u /* a commit had the wrong checksum or number of words; nothing changed, reported only */
#define RAC4I65_FAULTS_EXTERNAL 0x00000010u /* LCLK stood still, seen by the crystal; disarms */
#define RAC4I65_FAULTS_ARM_REFUSED 0x00000020u /* the second word of arming came while a cause stood, or out of order; reported only */
#define RAC4I65_FAULTS_STALL 0x00000040u /* an axis of `encoder_fault_mask` has its bit in `stall`; disarms */
#define RAC4I65_FIRST_FAULT 0x040u /* the fault that came first of those not cleared since; two bits where two came in one clock */
#define RAC4I65_FIRST_FAULT_WATCHDOG 0x00000001u /* no valid set-point commit for `watchdog_timeout`; disarms */
#define RAC4I65_FIRST_FAULT_EMERGENCY_STOP 0x00000002u /* emergency stop input high or open; disarms */
#define RAC4I65_FIRST_FAULT_ENCODER 0x00000004u /* an axis of `encoder_fault_mask` has its bit in `encoder_error`; disarms */
#define RAC4I65_FIRST_FAULT_COMMIT 0x00000008u /* a commit had the wrong checksum or number of words; nothing changed, reported only */
#define RAC4I65_FIRST_FAULT_EXTERNAL 0x00000010u /* LCLK stood still, seen by the crystal; disarms */
#define RAC4I65_FIRST_FAULT_ARM_REFUSED 0x00000020u /* the second word of arming came while a cause stood, or out of order; reported only */
#define RAC4I65_FIRST_FAULT_STALL 0x00000040u /* an axis of `encoder_fault_mask` has its bit in `stall`; disarms */
#define RAC4I65_STATUS 0x044u /* live state */
#define RAC4I65_STATUS_ARMED 0x00000001u /* outputs may be on */
#define RAC4I65_STATUS_SET_POINTS_VALID 0x00000002u /* a set point was committed since arming and has not timed out */
#define RAC4I65_STATUS_EMERGENCY_STOP 0x00000004u /* emergency stop input, live */
#define RAC4I65_STATUS_BALL 0x00000008u /* ball sensor, live */
#define RAC4I65_STATUS_SET_POINTS_PENDING 0x00000010u /* a commit of set points waits for the next tick */
#define RAC4I65_STATUS_CONFIGURATION_PENDING 0x00000020u /* a commit of the configuration waits for the next tick */
#define RAC4I65_COMMIT_SET_POINTS 0x048u /* checksum over the staged set points; a right one restarts the watchdog's time */
#define RAC4I65_COMMIT_CONFIGURATION 0x04cu /* checksum over the staged configuration */
#define RAC4I65_COMMITS 0x050u /* commits since configuration, wrapping */
#define RAC4I65_COMMITS_ACCEPTED 0x0000ffffu /* commits with the right checksum and number of words */
#define RAC4I65_COMMITS_REJECTED 0xffff0000u /* commits that changed nothing */
#define RAC4I65_ENCODER_ERROR 0x054u /* per axis: both lines changed at once */
#define RAC4I65_ENCODER_LINES 0x058u /* filtered lines, A of axis i in bit 2i, B in bit 2i + 1, index in bit 8 + i */
#define RAC4I65_ENCODER_FAULT_MASK 0x05cu /* axes whose encoder error disarms */
#define RAC4I65_KICKER_CONTROL 0x060u /* charging, discharging and automatic trigger */
#define RAC4I65_KICKER_CONTROL_CHARGE 0x00000001u /* charge the capacitor, until the time-out */
#define RAC4I65_KICKER_CONTROL_ARM_ON_BALL 0x00000002u /* fire once when the ball sensor sees the ball; it must rise while armed: set before, or after its shot, it must be cleared and set again; `kicker_status` shows whether it will fire */
#define RAC4I65_KICKER_CONTROL_HOLD 0x00000004u /* keep the charge while disarmed; an emergency stop or a dead clock discharges all the same */
#define RAC4I65_KICKER_CONTROL_BY_TIME 0x00000008u /* 1: charge until the time-out whatever `kicker_full` says; 0: stop charging while it is high */
#define RAC4I65_KICKER_FIRE 0x064u /* fires, when armed and not locked out */
#define RAC4I65_KICKER_FIRE_VALUE_FIRE 0x4b49434bu /* "KICK": fires; any other word does nothing */
#define RAC4I65_KICKER_PULSE 0x068u /* trigger pulse in microseconds; longer than 10000 acts as 10000 */
#define RAC4I65_KICKER_LOCKOUT 0x06cu /* microseconds after a pulse in which none can follow; less than 100000 acts as 100000 */
#define RAC4I65_KICKER_CHARGE_TIMEOUT 0x070u /* microseconds of charging, together, after which it stops until the capacitor is full, a pulse, or the card is disarmed: a request that is taken back and made again gains no time */
#define RAC4I65_KICKER_STATUS 0x074u /* state of the kicker; a write of anything but 0 to `faults` clears charge-timed-out and fire-dropped */
#define RAC4I65_KICKER_STATUS_STATE 0x00000007u /* 0 off (disarmed), 1 ready, 2 pending (charging is off, its gap runs), 3 pulse, 4 commutation, 5 lock-out */
#define RAC4I65_KICKER_STATUS_ON_BALL 0x00000008u /* the next ball fires: arm-on-ball rose while armed and has its shot */
#define RAC4I65_KICKER_STATUS_READY 0x00000010u /* a fire request would be taken */
#define RAC4I65_KICKER_STATUS_CHARGE_TIMED_OUT 0x00000020u /* charging used up its time-out; stays while that stops the charger */
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
#define RAC4I65_IMU_CONTROL 0x0a4u /* how the inertial sensor is read; the count of bytes is 14, most significant bit first, and what they mean is the driver's table of sensors */
#define RAC4I65_IMU_CONTROL_ENABLE 0x00000001u /* 1: read 14 bytes from register `first` on at every control tick; 0: the line is quiet but for `imu_access` */
#define RAC4I65_IMU_CONTROL_MODE_3 0x00000002u /* SPI mode, 1: mode 3, the clock rests high; 0: mode 0, it rests low */
#define RAC4I65_IMU_CONTROL_HALF 0x0000000cu /* half a period of the line's clock in clocks, less one: 0 to 3 are 16.7, 8.3, 5.6, 4.2 MHz at the nominal clock */
#define RAC4I65_IMU_CONTROL_FIRST 0x000007f0u /* first register of the 14 bytes; the read flag is put before it */
#define RAC4I65_IMU_ACCESS 0x0a8u /* 16 bits to the inertial sensor, highest first, at most 136 clocks; nothing is sent while `imu_control` enables reading or an access is on its way */
#define RAC4I65_IMU_ACCESS_DATA 0x000000ffu /* byte for the register; any value for a read */
#define RAC4I65_IMU_ACCESS_REGISTER 0x00007f00u /* register of the sensor */
#define RAC4I65_IMU_ACCESS_READ 0x00008000u /* 1: read; 0: write */
#define RAC4I65_IMU_STATUS 0x0acu /* answer to the last access; ff where no sensor answers, since the line is pulled up */
#define RAC4I65_IMU_STATUS_VALUE 0x000000ffu /* the last 8 bits from the sensor, whole when `busy` is 0 */
#define RAC4I65_IMU_STATUS_BUSY 0x00000100u /* an access or a burst is on its way */
#define RAC4I65_CONFIGURATION 0x400u /* staged configuration bank: thirteen groups of one word per axis */
#define RAC4I65_CONFIGURATION_INVERSE_X 0x400u /* Q2.16: speed LSB per LSB of velocity x; inverse kinematics: set point of the axis = sum over x, y, rotation */
#define RAC4I65_CONFIGURATION_INVERSE_Y 0x410u /* Q2.16: speed LSB per LSB of velocity y; inverse kinematics: set point of the axis = sum over x, y, rotation */
#define RAC4I65_CONFIGURATION_INVERSE_OMEGA 0x420u /* Q2.16: speed LSB per LSB of rotation; inverse kinematics: set point of the axis = sum over x, y, rotation */
#define RAC4I65_CONFIGURATION_DIRECT_X 0x430u /* Q22.8: 2 LSB of pose x per count; odometry: displacement of the body in its own frame, sum over the axes */
#define RAC4I65_CONFIGURATION_DIRECT_Y 0x440u /* Q22.8: 2 LSB of pose y per count; odometry: displacement of the body in its own frame, sum over the axes */
#define RAC4I65_CONFIGURATION_DIRECT_HEADING 0x450u /* Q22.8: 2^-32 turn per count, of half the turn; odometry: displacement of the body in its own frame, sum over the axes */
#define RAC4I65_CONFIGURATION_KP 0x460u /* Q8.16: duty LSB per speed LSB; proportional gain of the speed loop */
#define RAC4I65_CONFIGURATION_KI 0x470u /* Q2.22: duty LSB per speed LSB and tick; integral gain times the control period */
#define RAC4I65_CONFIGURATION_LOWER 0x480u /* Q6.24: 1 = full drive; smallest duty, at least -1 */
#define RAC4I65_CONFIGURATION_UPPER 0x490u /* Q6.24: 1 = full drive; largest duty, at most 1 */
#define RAC4I65_CONFIGURATION_KFF 0x4a0u /* Q2.16: duty LSB per speed LSB; feed-forward of the speed set point */
#define RAC4I65_CONFIGURATION_FALL 0x4b0u /* Q0.32: counts per clock and tick; largest step down of the set point, negative or 0 */
#define RAC4I65_CONFIGURATION_RISE 0x4c0u /* Q0.32: counts per clock and tick; largest step up of the set point; both 0 hold it */
#define RAC4I65_CONFIGURATION_WORDS 52u
#define RAC4I65_ACTIVE_CONFIGURATION 0x500u /* configuration in force */
#define RAC4I65_ACTIVE_CONFIGURATION_INVERSE_X 0x500u /* Q2.16: speed LSB per LSB of velocity x; inverse kinematics: set point of the axis = sum over x, y, rotation */
#define RAC4I65_ACTIVE_CONFIGURATION_INVERSE_Y 0x510u /* Q2.16: speed LSB per LSB of velocity y; inverse kinematics: set point of the axis = sum over x, y, rotation */
#define RAC4I65_ACTIVE_CONFIGURATION_INVERSE_OMEGA 0x520u /* Q2.16: speed LSB per LSB of rotation; inverse kinematics: set point of the axis = sum over x, y, rotation */
#define RAC4I65_ACTIVE_CONFIGURATION_DIRECT_X 0x530u /* Q22.8: 2 LSB of pose x per count; odometry: displacement of the body in its own frame, sum over the axes */
#define RAC4I65_ACTIVE_CONFIGURATION_DIRECT_Y 0x540u /* Q22.8: 2 LSB of pose y per count; odometry: displacement of the body in its own frame, sum over the axes */
#define RAC4I65_ACTIVE_CONFIGURATION_DIRECT_HEADING 0x550u /* Q22.8: 2^-32 turn per count, of half the turn; odometry: displacement of the body in its own frame, sum over the axes */
#define RAC4I65_ACTIVE_CONFIGURATION_KP 0x560u /* Q8.16: duty LSB per speed LSB; proportional gain of the speed loop */
#define RAC4I65_ACTIVE_CONFIGURATION_KI 0x570u /* Q2.22: duty LSB per speed LSB and tick; integral gain times the control period */
#define RAC4I65_ACTIVE_CONFIGURATION_LOWER 0x580u /* Q6.24: 1 = full drive; smallest duty, at least -1 */
#define RAC4I65_ACTIVE_CONFIGURATION_UPPER 0x590u /* Q6.24: 1 = full drive; largest duty, at most 1 */
#define RAC4I65_ACTIVE_CONFIGURATION_KFF 0x5a0u /* Q2.16: duty LSB per speed LSB; feed-forward of the speed set point */
#define RAC4I65_ACTIVE_CONFIGURATION_FALL 0x5b0u /* Q0.32: counts per clock and tick; largest step down of the set point, negative or 0 */
#define RAC4I65_ACTIVE_CONFIGURATION_RISE 0x5c0u /* Q0.32: counts per clock and tick; largest step up of the set point; both 0 hold it */
#define RAC4I65_ACTIVE_CONFIGURATION_WORDS 52u
#define RAC4I65_SET_POINTS 0x600u /* staged set points: as `mode` says a wheel speed per axis in counts per clock, LSB 2^-32, or body velocity x, y, rotation in units of the inverse matrix, and a spare */
#define RAC4I65_SET_POINTS_WORDS 4u
#define RAC4I65_ACTIVE_SET_POINTS 0x640u /* set points in force */
#define RAC4I65_ACTIVE_SET_POINTS_WORDS 4u
#define RAC4I65_INDEX_POSITION 0x770u /* counts at the last captured index, in the frame before it was cleared, two's complement */
#define RAC4I65_INDEX_POSITION_WORDS 4u
#define RAC4I65_INTEGRALS 0x790u /* integrators of the speed loops; not part of a snapshot */
#define RAC4I65_INTEGRALS_WORDS 4u
#define RAC4I65_SNAPSHOT_SEQUENCE 0x800u /* number of the control tick that finished last, at most a period and 1000 clocks old; reading it latches the snapshot, so that all its words are of this tick until the last one is read */
#define RAC4I65_SNAPSHOT_STATUS 0x804u /* `status` at the tick, without what is pending */
#define RAC4I65_SNAPSHOT_STATUS_ARMED 0x00000001u /* outputs may be on */
#define RAC4I65_SNAPSHOT_STATUS_SET_POINTS_VALID 0x00000002u /* a set point was committed since arming and has not timed out */
#define RAC4I65_SNAPSHOT_STATUS_EMERGENCY_STOP 0x00000004u /* emergency stop input, live */
#define RAC4I65_SNAPSHOT_STATUS_BALL 0x00000008u /* ball sensor, live */
#define RAC4I65_SNAPSHOT_STATUS_SET_POINTS_PENDING 0x00000010u /* a commit of set points waits for the next tick */
#define RAC4I65_SNAPSHOT_STATUS_CONFIGURATION_PENDING 0x00000020u /* a commit of the configuration waits for the next tick */
#define RAC4I65_SNAPSHOT_TIME 0x808u /* low 24 bits of `time` at the tick */
#define RAC4I65_SNAPSHOT_FAULTS 0x80cu /* `faults` at the tick */
#define RAC4I65_SNAPSHOT_FAULTS_WATCHDOG 0x00000001u /* no valid set-point commit for `watchdog_timeout`; disarms */
#define RAC4I65_SNAPSHOT_FAULTS_EMERGENCY_STOP 0x00000002u /* emergency stop input high or open; disarms */
#define RAC4I65_SNAPSHOT_FAULTS_ENCODER 0x00000004u /* an axis of `encoder_fault_mask` has its bit in `encoder_error`; disarms */
#define RAC4I65_SNAPSHOT_FAULTS_COMMIT 0x00000008u /* a commit had the wrong checksum or number of words; nothing changed, reported only */
#define RAC4I65_SNAPSHOT_FAULTS_EXTERNAL 0x00000010u /* LCLK stood still, seen by the crystal; disarms */
#define RAC4I65_SNAPSHOT_FAULTS_ARM_REFUSED 0x00000020u /* the second word of arming came while a cause stood, or out of order; reported only */
#define RAC4I65_SNAPSHOT_FAULTS_STALL 0x00000040u /* an axis of `encoder_fault_mask` has its bit in `stall`; disarms */
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
#define RAC4I65_SNAPSHOT_IMU 0x860u /* reading of the inertial sensor that began with the tick, to be read before `snapshot_sequence_end`: first the clocks from the last rise of the data-ready line to the tick, 65535 where none came within 65534 or reading is off, when the other words mean nothing; then seven words of two bytes, the first byte in bits 15:8 */
#define RAC4I65_SNAPSHOT_IMU_WORDS 8u

#endif
