#!/bin/busybox sh
# The virtual machine's first process: racbot as its users call it, and the host outside told when to look.
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
mount -t tmpfs tmpfs /tmp
# The card's time is what this tells, so it comes before everything else.
testport now
testport clock &
card=/sys/bus/pci/devices/0000:00:05.0

# Says something to the host, for which time stands still until it is done.
host() { reply=$(testport say "$@"); }
run() { echo "\$ racbot $*"; racbot "$@" 2>&1; echo "exit $?"; }
# A drive of some seconds in the background, and the robot in full motion.
far() {
    echo "\$ racbot drive --robot /robot.toml --setpoints /far.csv &"
    racbot drive --robot /robot.toml --setpoints /far.csv 2>&1 &
    pid=$!
    sleep 1.5
}
# How it ended.
ended() { wait $pid; echo "exit $?"; }
record() {
    mkdir /tmp/run
    run drive --robot /robot.toml --setpoints /two.csv --record /tmp/run/run.csv
    tar cz -C /tmp/run . | testport send recording.tar
}
scene() { echo "== $*"; }

host boot
case $reply in
1)
    scene find
    run info --list
    run info
    scene load
    run load /rac4i65.bit
    host mark loaded
    run info
    scene kept
    run load /rac4i65.bit
    scene drive
    record
    host mark driven
    scene kick
    run kick --robot /robot.toml --charge-s 0.2
    host mark kicked
    scene kill
    far
    host mark moving
    kill -9 $pid
    ended
    host mark killed
    sleep 0.3
    host mark silent
    scene reload
    run load /rac4i65.bit --force
    host mark reloaded
    scene corrupt
    run load /corrupt.bit --force
    host mark corrupt
    scene other
    run load /other.bit --force
    host mark other
    scene done-low
    host fault done-low
    run load /rac4i65.bit --force --tries 1
    host mark done-low
    scene init-low
    host fault init-low
    run load /rac4i65.bit
    scene lost-byte
    host fault lost-byte
    run load /rac4i65.bit --tries 1
    host fault none
    scene gone
    run load /rac4i65.bit
    far
    host mark before-gone
    host fault absent
    ended
    sleep 0.3
    host fault none
    host mark gone
    scene reset
    far
    host mark before-reset
    reboot -f
    ;;
2)
    host mark after-reset
    run info
    run load /rac4i65.bit
    scene unplugged
    far
    host mark before-unplugged
    host unplug
    ended
    sleep 0.3
    host mark unplugged
    run info
    poweroff -f
    ;;
verilog)
    scene load
    run load /rac4i65.bit
    scene drive
    record
    scene kick
    run kick --robot /robot.toml --charge-s 0.2
    scene kill
    far
    host mark moving
    kill -9 $pid
    ended
    sleep 0.6
    host mark silent
    poweroff -f
    ;;
other)
    scene other-card
    run info --list
    run load /rac4i65.bit
    scene no-card
    echo 1 >$card/remove
    run load /rac4i65.bit
    run drive --setpoints /two.csv
    poweroff -f
    ;;
*) poweroff -f ;;
esac
