//! Every figure by which the workflow decides, with its unit, its reason and the experiment that set it; the report and
//! `gap.json` state them all, and `docs/measured/ablation.md` says what each does.
//!
//! None is a size of one robot: lengths, masses, torques and speeds are measured in those of the log at hand, in counts
//! of its encoders, or in its noise. What belongs to the physics of a link stands in `links::thresholds`, with the gate
//! that whatever is named must pass.

use links::effect::Link;

/// A threshold as it is stated.
#[derive(Debug, Clone, PartialEq)]
pub struct Stated {
    /// Of the field.
    pub name: &'static str,
    /// One, or one of each kind that the meaning lists.
    pub values: Vec<f64>,
    /// What it is, why, and what set it.
    pub meaning: &'static str,
}

trait Figures {
    fn figures(self) -> Vec<f64>;
}

impl Figures for f64 {
    fn figures(self) -> Vec<f64> {
        vec![self]
    }
}

impl Figures for usize {
    fn figures(self) -> Vec<f64> {
        vec![self as f64]
    }
}

impl<const N: usize> Figures for [f64; N] {
    fn figures(self) -> Vec<f64> {
        self.to_vec()
    }
}

macro_rules! thresholds {
    ($($(#[doc = $meaning:literal])+ $name:ident: $kind:ty = $value:expr,)+) => {
        /// Fixed before anything is fitted.
        #[derive(Debug, Clone, PartialEq)]
        pub struct Thresholds {
            $($(#[doc = $meaning])+ pub $name: $kind,)+
        }

        impl Default for Thresholds {
            fn default() -> Self {
                Self { $($name: $value,)+ }
            }
        }

        impl Thresholds {
            /// Every threshold with its value here, in the order of the report's table.
            pub fn stated(&self) -> Vec<Stated> {
                vec![$(Stated {
                    name: stringify!($name),
                    values: Figures::figures(self.$name),
                    meaning: concat!($($meaning),+).trim_ascii_start(),
                },)+]
            }
        }
    };
}

thresholds! {
    // What every robot has a little of.
    /// Standard deviation of an effect that is not named, as a share of its materiality threshold.
    held_share: f64 = 0.25,
    /// The same for effects that are switched on, as a share of the size they are tried at.
    held_switch: f64 = 0.15,
    /// Standard deviations that it may go beyond its bounds, as laws that are not exact ask for: with 2 of them friction of simulated
    /// arms lost its name to theirs. Duties that acted early by five hid an axis that was a third lighter.
    held_beyond: f64 = 3.0,
    /// Share of a named effect that an effect of the same look may have without being named, where the law is one of
    /// friction or motors.
    law_share: f64 = 0.08,
    /// Standard deviations of the named effects' laws that another effect must explain more than.
    law_sigmas: f64 = 2.0,
    /// Squared cosine from which two columns are one, of which one is held: several would add their margins.
    one: f64 = 0.99,
    /// Squared cosine from which an effect looks like others.
    alike: f64 = 0.98,
    /// Share of what a law does that several others may not do together for it to be a special case of them. By algebra it is
    /// 0, by differences 1e-9 to 5e-9 (a supply beside a motor's two constants, an inertia beside resistance and friction); of
    /// what merely looks alike, a bridge that drops volts beside a motor's constant and viscous friction, 1e-3.
    special: f64 = 1e-6,
    /// Share of what an unnamed effect does that the named ones could do in its place, from which it is frozen while
    /// they are estimated: they would share the signal (-2.3 % was found where -3.6 % is true).
    twin: f64 = 0.3,

    // What an effect must gain to be named.
    /// Objective an effect must gain after paying for its parameters.
    gain: f64 = 4.0,
    /// Cost of naming an effect, and of each parameter beyond the first.
    costs: [f64; 2] = [8.0, 2.0],
    /// Share of the held-out sum of squares an effect must explain: motion, drive.
    shares: [f64; 2] = [0.003, 0.02],
    /// Share of what exceeds the noise, held out, that an effect must explain.
    share_of_excess: f64 = 0.12,
    /// Held-out gain over clusters in units of its own spread.
    held_out_t: f64 = 2.0,
    /// Gain from which half of that is asked of single clusters, and what happens in one run alone is predicted from
    /// that run's own parts.
    strong: f64 = 50.0,
    /// Gain, in that, from which an effect counts that a straight line leads out of its bounds: there it is a rough guess.
    led_out: f64 = 2.0,
    /// Share of the held-out sum of squares that such an effect may add on the other runs.
    harms: f64 = 0.01,
    /// Share of the torque that motors gave, RMS, that an effect without a little of it in every robot must take: as much as
    /// a torque constant worth a name. Play of a simulated mecanum robot looked like a current limit that takes 0.035 of it;
    /// limits that are found in the blind series of axes take 0.05 to 0.20.
    takes: f64 = 0.05,
    /// Squared floors of its link that an effect which is switched on must close as written: it fits single moments, of which
    /// chance has many. Of data sets of other simulators limits of currents and slip that were not there closed up to 0.03, and
    /// what was there 0.13 and more.
    switched_closes: f64 = 0.06,
    /// p up to which chance is no explanation: of the hundred forms that a link is searched for one has as much by chance in ten
    /// data sets. Beyond, as in logs too short for less, nothing is named on a link that agrees without it. Of 475 names in 500
    /// data sets of another simulator two had more, both false, and so had two in 32 clean drives of one manoeuvre each.
    surely: f64 = 0.001,
    /// Correlation of drive residuals: how many count as one.
    drive_correlation: f64 = 1.5,

    // Between explanations.
    /// Objectives that differ by less are a tie, which the order of the catalogue breaks; and the share of what an
    /// effect gains that its law is not exact enough to decide by.
    ties: [f64; 2] = [4.0, 0.01],
    /// Rows within which a motor may follow by its file without showing beside a filter or a latency: one, and the half by which
    /// the age of rows is known, for as late as a motor is a speed of the row before is as well. A motor of 1.2 rows behind a
    /// filter of three was one of 2.7 times its inertia, next to the noise.
    hidden_rows: f64 = 1.5,
    /// Share of what the inertia of such a motor explains that a latency may leave in its place and still be as likely: no row
    /// tells what goes on within it. Of six simulated axes whose time constant was half a row, and their latency too, the
    /// latency left 0.05, 0.04 and 0.24 of what an inertia of twice the file's explained, and less in the others.
    late_law: f64 = 0.25,
    /// Objectives that differ by less are reported as a tie.
    tied: f64 = 6.0,
    /// Closer than this an explanation is in doubt (Kass and Raftery 1995: very strong from 10).
    doubtful: f64 = 10.0,
    /// Gain by which a straight line may stay below that of the named effect, and the share of that gain, for another to
    /// be fitted in its place.
    near: [f64; 2] = [12.0, 0.1],
    /// Objective by which a search that began with a pair must be better than one that added effect after effect.
    first: f64 = 2.0,
    /// Share of what either of two effects adds to the other that one in place of both may leave.
    does_both: f64 = 0.1,
    /// Squared cosine with what an effect of several parameters can do from which it hides another: the other's limit is
    /// three times what it is alone. Wheels that are all skewed by 7 degrees tell a turned marker plate from a common
    /// skew by their second order only; 0.13 rad of it passed for skews (blind bench).
    hides: f64 = 0.9,

    // Where noise is not what limits the prediction.
    /// Noise floors left after a selection from which it is made again with nothing adjusted.
    open: f64 = 1.5,
    /// Share of the held-out sum of squares that each parameter of an effect must then explain.
    price: f64 = 0.004,
    /// Share of the best reduction from which an explanation with fewer parameters, or earlier in the catalogue, is as
    /// good.
    as_good: f64 = 0.97,
    /// Share of what exceeds the noise that all effects together must close, held out.
    closes: f64 = 0.3,
    /// Share of the squares of a link next to its noise that play must close: of two clean axes of 200 on which it was found it
    /// closed 0.08 and 0.14, of nine with play 0.21 to 0.98.
    play_closes: f64 = 0.18,
    /// Share of a held-out sum of squares by which a selection with more parameters must be better.
    better: f64 = 0.03,
    /// Share of the squared residual that the estimates may leave more than the best ones of what is named.
    worse: f64 = 0.1,
    /// Share of a gap that adjustments without a name may leave of it; where they close more, what could be named for it
    /// is looked for.
    adjusted: f64 = 0.7,
    /// Noise floors left on the drive from which it is searched again with next to no margin for what is not named. On
    /// simulated robots 1.0 to 1.3 are left; on a real one whose friction nobody had told (four wheels, 60 Hz) 4.4.
    far_left: f64 = 3.0,
    /// Residuals up to which the outcome of that is as good.
    as_well: f64 = 1.15,
    /// Share of what a law leaves above the noise, beyond that many floors, within which another law is as good: on the
    /// same robot friction leaves 8 % more than a bridge that is not linear, and neither half of the gap.
    undecided: f64 = 0.3,
    /// Floors left in the window in the middle, on the link of camera and wheels, from which nothing has a name that closes less than the share of
    /// `undecided` of what is left above the noise. On squares of a real robot with four mecanum wheels 4.0 were left, and
    /// skews of 1 to 2 degrees closed 0.14 of them, one factor of its sideways motion as much; simulated slip that grows with
    /// the speed left 2.7, and the angles of two wheels closed 0.19. On circles of the same robot 1.8 were left, and what
    /// closed a tenth was an expert's, too.
    dwarfs: f64 = 2.0,
    /// Floors from which a law that leaves them is far from the noise beside one that does not: a motor of 12 counts a
    /// turn whose torque constant was 13 % off left 2.0 by viscous friction and 1.1 by the torque constant.
    from_noise: f64 = 1.5,
    /// Standard deviations by which one law of the drive must leave more than another that leaves hardly more than
    /// noise, each fitted with nothing adjusted beside it, for that to speak against it: five, beyond what a bias of the
    /// fit makes of noise. On ten simulated flywheels with dry and viscous friction the laws that were not at work left 5
    /// to 330 more. A dead band for dry friction leaves 5 to 14 less there, by how exact the two laws are near rest:
    /// twins are not told by this.
    told: f64 = 5.0,
    /// Share of what is more than noise without it that an effect too small to matter alone must close to be named
    /// beside others. A servo's viscous friction, a tenth of its dry friction, closed all that this left; on wheels that
    /// stick between moves viscous friction that is not there closes a part of it, estimated at a quarter and not
    /// measured.
    least_together: f64 = 0.5,

    // An inertia far from the file's: accelerations go with its inverse, and a straight line does not reach it.
    /// Inertia, in the file's, that must be within an effect's bounds for the drive to be fitted from its lightest on, and
    /// below which one that was found so is kept for the next look: half of it is less than any margin is. With ten times
    /// the inertia in the file a weight beside the shaft was named, or nothing.
    lighter: [f64; 2] = [0.1, 0.5],
    /// Inertia, in the file's, from which a heavier one is fitted on an axis on blocks, and beyond which it must end. Single
    /// steps of an axis with a third of its inertia in the file, and no friction, left 15 to 50 floors by laws that bend
    /// speeds. A load of half as much again, beside a friction, comes out in a tie with a motor that warms, and on an axis
    /// that lacked a friction alone (blind bench) a tenth of the inertia was named with two laws more.
    // That axis has the seed 17359735160358586713.
    heavier: [f64; 2] = [3.0, 1.5],

    // Counts that a decoder takes of other edges than the file says: a quarter, half, twice or four times.
    /// Relative distance from such a factor within which counts are off by it. Of robots that are heavier and rub more,
    /// which do the same to their drives, one in sixteen comes as near by chance; the drives of simulated ones tell it to
    /// 0.4 %.
    decoded: f64 = 0.02,

    // What speaks against a name.
    /// Standard deviations by which a free simulation must get worse to speak against an effect: as many as 2.3 % of
    /// noise.
    runaway: f64 = 2.0,
    /// Squared gap that one effect may open by itself, in those of the link before anything was named, beyond which it
    /// only takes back what others named beside it do. On a short log of the example set a motor 130 K warm and 73 %
    /// stronger, which gap opened 20 times as far without either, passed for a few per cent of rolling loss.
    cancels: f64 = 4.0,
    /// Share of a link's gap that must be left at most once its effects stand in the file; on the motion link what the
    /// fit must close held out decides.
    falls: f64 = 0.98,
    /// Chance of runs that differ as much by what clusters scatter, below which the runs' own spread makes the interval.
    runs_differ: f64 = 0.05,

    // Runs of one data set that are not of one robot as it was.
    /// Most parameters of an effect that runs may differ in: of more each is known too badly from one run alone. On circles
    /// of three omni wheels one run gave a wheel's radius as 20 % larger, beside two others that were smaller.
    differ_parameters: usize = 2,
    /// By how much more another effect must close to stand for one that comes earlier in the catalogue. Reasoned: less is
    /// no reason to leave its order.
    differ_more: f64 = 1.05,
    /// Runs whose values are all told; of more the least and the greatest. Reasoned: a sentence holds no more.
    differ_told: usize = 6,
    /// Share of the fastest speed of all runs from which a wheel turns, and share of its moments at either end that are
    /// none of its run's level. Reasoned: standing and changing speed say nothing of the level.
    level: [f64; 2] = [0.05, 0.1],
    /// Ticks of a run that tell its level, at most. Reasoned: the share at either end is known to 0.005 from so many.
    level_ticks: usize = 4096,
    /// By how much of the usual range of a run's speeds the levels of runs lie apart from which each has a level of its
    /// own: of eight steps of a fan, each a tenth of the supply higher, 0.75; of drives to and fro, 0.1. Ten steps of one
    /// motor were called machines with loads of 8 to 11 Nm, five times what it can hold.
    levels_apart: f64 = 0.5,

    // Floors, and what is said of what is left.
    /// Share of the drive's torque that wheels lose as they roll, which no file of a robot gives and no name is due to:
    /// rollers and contacts of omni wheels lose 0.005 to 0.011 of the load, one to three hundredths of their grip
    /// (rigid-body engine, robots of 1.6 to 3.8 kg); on the simulator, whose truth has both, 2.4 % of it remain on the
    /// example set once its skews are named.
    rolling_loses: f64 = 0.02,
    /// Share of the drive's torque that a winding loses within 2 K, which no file of a motor gives: copper's resistance
    /// grows by 0.39 % a kelvin. The floor of an axis on blocks, where nothing rolls.
    warmth: f64 = 0.008,
    /// Torque of static friction that may have acted in a test function, as its share of the test function in which the
    /// wheel may have stuck times its size, from which the test function says nothing of the wheel: one standard
    /// deviation of the noise.
    sticks: f64 = 1.0,
    /// Share of the test functions that must go for that before what is named is looked at again without them.
    sticks_often: f64 = 0.02,
    /// Share of the information on a small effect that the floor must have hidden for another look above a lower one.
    hidden: f64 = 0.2,
    /// Noise floors from which a link does not agree: effects too small to matter alone are then named together.
    far: f64 = 3.0,
    /// What matters within a window of motion, as a share of what its wheels rolled, and of the turn they could have
    /// made of it: 4 mm and 0.02 rad where wheels roll 0.42 m in a second, 8 cm from the centre (four example sets).
    matters: [f64; 2] = [0.0095, 0.0038],
    /// Noise floors left of a link from which what is named must close all of its squared gap but the share of `undecided`
    /// to be the answer, each of it more than is left; else it is merely the nearest. The radii of four mecanum wheels
    /// closed more than half and left 35 floors, which rollers that slip had made.
    far_open: f64 = 10.0,
    /// Noise floors that are worth a sentence.
    worth_saying: f64 = 1.5,
    /// Share of the squared gap that named effects close at least on a link that they explain.
    explained: f64 = 0.5,
    /// Share of the explained gap that the inexactness of a law may leave as structure.
    law_leaves: f64 = 0.05,
    /// RMS residual of a window that is far from what a second of noise reaches; the same where wheels slip, whose law is
    /// not exact.
    missed: [f64; 2] = [1.35, 2.0],
    /// Limits of detection, in sizes that matter, at the middle of all effects of a link, from which that nothing shows
    /// there says nothing. On the effect-free example set it is 1.2; three steps of 0.4 s on a lifted wheel with 48 counts
    /// a turn had 38, and were called agreement though a rotor of twice the inertia would not have shown.
    blind: f64 = 10.0,
    /// Limit of detection, in sizes that matter, up to which the camera decides on what both links show.
    seen: f64 = 2.0,

    // Wheels and poses along ways of several seconds.
    /// Windows of a data set in which ways are compared, and their length in windows of single frames, at least and at most.
    /// Reasoned: chance is told by windows, and a heading that is off bends more than ten of them.
    ways: [f64; 3] = [24.0, 3.0, 10.0],
    /// By how much smaller a size of the wheels must tell along ways for these to be compared in place of single frames. Of 59
    /// recordings of three machines by others a body radius told from 6.9 % in single frames and from 1.3 % along ways
    /// (two wheels on circles); wheels of 281 simulated sets, most of them faster, tell in single frames in all but two.
    tells_more: f64 = 2.0,
    /// How far wheels may wander in a window of single frames beside every effect for ways to be compared, in what matters: along
    /// an axis, and in heading. Of the same recordings those of two wheels had up to 0.8 and 2.5, four mecanum wheels on circles 1.0
    /// and 1.6; three omni wheels, whose rollers do again what they did a turn before, 1.6 to 2.2 and up to 3; slip on
    /// squares 3.7 and 8, a simulated camera that wobbles 2.8, simulated slip 19.
    wanders: [f64; 2] = [1.5, 3.0],

    // Structure that no effect of the catalogue leaves. Sizes are beside what the motors gave.
    /// Chance of any false alarm of one kind in a data set, all places looked at paid for.
    false_alarm: f64 = 1e-3,
    /// Torque of a short push as a share of the drive's; its robust standard deviations; and what it is in units of what
    /// a tenth of the time exceeds: pushes are rare. Reasoned.
    burst: [f64; 3] = [0.1, 9.0, 5.0],
    /// Share of its impulse that a push leaves with the robot: a wheel that slips, or crosses its gear's play, gives back
    /// what it took; and its torque in that which the acceleration of the moment took: a push is what accelerates. Where
    /// rows are far apart beside a motor's time constant its laws are off by 0.2 of that as duties step.
    pushed: [f64; 2] = [0.6, 0.5],
    /// Mean torque of some seconds along the rotation as a share of the drive's, and in standard errors of such means.
    /// Reasoned.
    stretch: [f64; 2] = [0.05, 8.0],
    /// Amplitude of a line in the spectrum of a wheel's torque as a share of the drive's; its share of the squared torque
    /// that is left; and its amplitude beside what the drive did at that frequency: below, it is a misfit of a law.
    line: [f64; 3] = [0.03, 0.1, 0.15],
    /// Amplitude of a rolling radius that varies with the wheel's angle, and of a torque that does, as a share of the
    /// drive's: handed from roller to roller every omni wheel bobs by some hundredths of a millimetre and is pushed by a
    /// few mNm, which look like a radius that varies by up to 0.0035. Without rollers a torque has the size of a `line`.
    ripple: [f64; 2] = [0.006, 0.07],
    /// Share of the weight on a wheel, at its rim, by which rollers push as they are handed over, whatever the speed: three
    /// wheels, and four, of which one always hangs. 0.01 to 0.04 and up to 0.1 in a rigid-body engine.
    bobs: [f64; 2] = [0.05, 0.2],
    /// Chance of phases that agree as well in noise, whatever the amplitudes: bursts are no lines.
    phases: f64 = 1e-4,
    /// Accelerations beyond which a rotor must be between its flanks, in those that stalled motors can give a wheel with
    /// its share of the robot, for they brake twice as hard; share of the ticks about one that are beyond, where a wheel
    /// rattles; and share of all ticks at which it must.
    rattles: [f64; 3] = [2.0, 0.3, 0.05],
    /// Shaking of a rotor from which its play has a name, rad at the motor shaft: a gear's backlash is given in tenths of
    /// a degree to degrees there.
    shakes: f64 = 0.03,
    /// Share of what the robot moved between a frame's regular time and its stamp by which poses must be off for stamps to
    /// scatter, and in standard errors: 1 where they do, less where they scatter by so much of a period that regular times
    /// are mistaken; 0 where frames come unevenly, as of a camera that waits for light or a computer that is busy. Their
    /// stamps were called scatter on 13 of 44 sets of another simulator, and on none since but one whose stamps do scatter.
    stamps: [f64; 2] = [0.3, 2.0],
    /// Share of the camera's frames that repeat the one before while the wheels turn, from which it is said.
    frozen: f64 = 0.015,
    /// How far a camera's frame may lie from the one before, in the way that the fastest wheels of the piece make possible
    /// and, added to that, in the noise of a frame; and share of the frames that may lie farther. Reasoned.
    torn: [f64; 3] = [2.0, 10.0, 0.1],

    /// By how much wheels that wear or are pressed flat are smaller than their file at most. One robot of three omni wheels
    /// went 14 % less far than its wheels turned on a table, where its camera may be off by as much, and 18 and 31 % on two
    /// floors.
    worn: f64 = 0.05,

    // Links that are replayed tick by tick.
    /// Largest duty below which the firmware may limit it, and the share of the ticks at which it must lie there. Reasoned:
    /// a bridge gives all but its dead times, and a peak that is reached once is no limit.
    limited: [f64; 2] = [0.98, 0.01],
    /// Share of ticks that may differ by more than rounding: set points, duties. As many set points may follow the
    /// command of the tick before, which arrived within the tick.
    differs: [f64; 2] = [0.01, 0.005],
    /// Part of a set point by which it may be off as it was written: six digits are what `%g` and the streams of C++ write,
    /// and a map's scale hides where they end.
    digits: f64 = 1e-5,
    /// Share of the squared error that a hypothesis must remove: set points, duties.
    removes: [f64; 2] = [0.9, 0.8],
    /// Share of the wrong ticks that it may leave wrong. True gains, found to 0.05 %, left 0.6 of them; with a gear ratio
    /// in the file that was 19 % off, gains without an integrator removed 0.9 of the square and left 1.01.
    left_wrong: f64 = 0.8,
    /// Share by which the rate of a log may differ from that of the loop that is replayed.
    rate: f64 = 0.05,

    // Loops that answer what a model lacks.
    /// Share of what is left on the drive that duties and speeds do which the set points do not account for, from which
    /// effects are judged by what the set points made: most of it then is no noise, and biases what is fitted to duties.
    /// 24 simulated loops: 0.00 to 0.29 without a torque that nobody modelled, 0.65 to 0.98 with one of 0.05 to 0.1 of
    /// the stall torque (0.1 to 0.8 before effects are named); four simulated robots 0.01 to 0.06. Before effects are named
    /// it counts unless they explain, by the share of `explained`, what no answer does: weights beside a shaft had 0.66 and
    /// 0.84 before, 0.004 after.
    answered: f64 = 0.5,
    /// Squared standard deviations a size, by which what was named must leave less beside the answers, as the set points make
    /// it, for a size beyond its interval to be one that was fitted to the answers: three standard deviations each. Reasoned;
    /// two servos had 62 and 95, a loop without pushes 0.6.
    against_a_size: f64 = 9.0,

    /// Share of a motor's constant or resistance by which what is named of it may differ beyond its interval from what currents
    /// beside the duties say: iron and brushes are in the one and not in the other. Reasoned; of an electric bicycle the
    /// constant was named 58 % smaller than its currents have it.
    against_currents: f64 = 0.1,

    // Laws that only braking tells apart.
    /// Share of the rows of turning wheels whose duties work against the motion up to which a dead band is a dry friction as
    /// well, and of the test functions in which their motors do, up to which volts that a bridge takes off are one: more such
    /// rows tell them apart, by twice the band each. Position loops against much friction, simulated: 0 of 49 719; with what
    /// the log leaves unknown of small speeds, less than one in a hundred is none. And the speed from which a wheel surely
    /// turns one way, in what is known of a direction. Reasoned.
    braked: [f64; 2] = [0.01, 3.0],

    // Logs that say nothing of a drive.
    /// Share of the torque that the motors reach in the logs beyond which scatter is no noise of a drive.
    no_noise: f64 = 0.15,
    /// Share of what a duty varies that its wheel's motion accounts for, from which it is this drive's, however much
    /// scatters: less, and most of it has nothing to do with the wheel. Reasoned, and tried on two: a motor's log with
    /// foreign duties, and one whose amplifier wanders by a tenth.
    foreign: f64 = 0.5,
    /// Control periods between two rows of a log beyond which its times are in another unit.
    odd_rows: f64 = 300.0,
}

/// Relative uncertainty of a law of friction or motors, to which `law_share` belongs.
const ORDINARY_LAW: f64 = 0.015;

impl Thresholds {
    /// The same with next to no margin for what is not named.
    pub fn narrow(&self) -> Self {
        Self { held_share: 0.1 * self.held_share, held_switch: 0.1 * self.held_switch, ..self.clone() }
    }

    /// Share of a named effect whose law is that uncertain which a look-alike may have without being named.
    pub fn law_share(&self, uncertainty: f64) -> f64 {
        self.law_share * (uncertainty / ORDINARY_LAW).min(1.0)
    }

    /// Cost of freeing an effect with this many parameters.
    pub fn cost(&self, parameters: usize) -> f64 {
        self.costs[0] + self.costs[1] * parameters.saturating_sub(1) as f64
    }

    /// Difference below which two explanations that gain this much are a tie.
    pub fn tie(&self, gain: f64) -> f64 {
        self.ties[0].max(self.ties[1] * gain)
    }

    /// Difference below which they are reported as one.
    pub fn tied(&self, gain: f64) -> f64 {
        self.tie(gain).max(self.tied)
    }

    /// Gain by a straight line from which another explanation is fitted in place of one that gains this much.
    pub fn near(&self, gain: f64) -> f64 {
        gain - self.near[0] - self.near[1] * gain.abs()
    }

    /// Share of the held-out sum of squares.
    pub fn share(&self, link: Link) -> f64 {
        if link == Link::Motion { self.shares[0] } else { self.shares[1] }
    }

    /// Whether the floors left of one law speak against it beside those that another one of no more parameters leaves,
    /// however much both explain: far from the noise, where the other is hardly above it. A servo whose torque constant
    /// was 17 % off (500 floors) was explained to 1 % by viscous friction, which left 26 floors where the torque constant
    /// left 0.9.
    pub fn decided(&self, worse: f64, better: f64) -> bool {
        let excess = |floors: f64| (floors * floors - 1.0).max(0.0);
        worse > self.from_noise && excess(better) < self.undecided * excess(worse)
    }

    /// Residuals per independent one.
    pub fn correlation(&self, link: Link) -> f64 {
        if link == Link::Motion { 1.0 } else { self.drive_correlation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_is_decided_against_only_far_from_the_noise() {
        // Floors left by the one, by the other, and whether that speaks against the one.
        for (worse, better, wanted) in
            [(26.0, 0.9, true), (2.0, 1.1, true), (1.4, 0.9, false), (26.0, 20.0, false), (1.0, 26.0, false)]
        {
            assert_eq!(Thresholds::default().decided(worse, better), wanted, "{worse} {better}");
        }
    }

    #[test]
    fn every_threshold_is_stated_with_its_meaning_in_whole_sentences() {
        let stated = Thresholds { costs: [1.0, 2.5], ..Thresholds::default() }.stated();
        assert!(stated.iter().any(|s| s.name == "costs" && s.values == [1.0, 2.5]));
        for s in &stated {
            assert!(s.meaning.ends_with('.') && !s.meaning.contains("  "), "{}: {}", s.name, s.meaning);
        }
    }
}
