#!/bin/busybox sh
# The virtual machine's first process: racbot as its users call it, and the host outside told when to look.
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
mount -t tmpfs tmpfs /tmp
stty -F /dev/ttyS1 raw -echo
exec 3<>/dev/ttyS1
card=/sys/bus/pci/devices/0000:00:05.0

# Says something to the host and waits until it is done.
host() { echo "$*" >&3; read -r reply <&3; }
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
# A host that is too busy makes the watchdog bite: then once more, at most twice, for all to see.
record() {
    for try in 1 2 3; do
        rm -rf /tmp/run
        mkdir /tmp/run
        echo "\$ racbot drive --robot /robot.toml --setpoints /two.csv --record /tmp/run/run.csv"
        racbot drive --robot /robot.toml --setpoints /two.csv --record /tmp/run/run.csv 2>&1 && break
        echo "exit 1, try $try"
    done
    echo "exit $?"
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
    tar c -C /tmp/run . >/dev/nvme0n1
    sync
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
    tar c -C /tmp/run . >/dev/nvme0n1
    sync
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
esac
