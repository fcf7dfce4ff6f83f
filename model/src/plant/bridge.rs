//! From duties to voltages: bridge, battery and warm windings.

use std::collections::VecDeque;

use super::Plant;
use crate::motor::Axis;

/// Duties on their way, oldest first.
pub(super) type Delayed = VecDeque<Vec<f64>>;

impl Plant {
    /// Sets the torque of every winding for one tick.
    pub(super) fn energise(&mut self, duty: &[f64], supply_v: f64, dt: f64) {
        let mut acting = std::mem::take(&mut self.acting);
        for (i, acting) in acting.iter_mut().enumerate() {
            *acting = duty.get(i).copied().unwrap_or(0.0).clamp(-1.0, 1.0);
        }
        let mut supply = supply_v;
        if let Some(d) = self.deviations.as_deref() {
            delay(&mut self.delayed, &mut acting, d.duty_delay_s / dt);
            for (i, u) in acting.iter_mut().enumerate() {
                let band = d.dead_band.get(i).copied().unwrap_or(0.0);
                let lost = if d.dead_band_passes && u.abs() > band { 0.0 } else { band };
                *u = u.signum() * (u.abs() - lost).max(0.0);
                *u *= 1.0 + d.curvature * (u.abs() - 1.0);
            }
            let [rise, time] = d.heating;
            for (i, wheel) in self.wheels.iter_mut().enumerate() {
                if rise != 0.0 {
                    wheel.heat += dt / time * (acting[i] * acting[i] - wheel.heat);
                    let cold = &self.cold[i];
                    let hot = 1.0 + rise * wheel.heat;
                    self.axes[i] =
                        Axis { torque_per_volt: cold.torque_per_volt / hot, damping: cold.damping / hot, ..*cold };
                }
            }
            let [drop, ohm] = d.battery;
            self.fallen_v += d.supply_fall_v_per_s * dt;
            supply = (supply - drop - self.fallen_v).max(0.0);
            if ohm != 0.0 {
                // The bridges draw Σ u·i with i = (u·V − e)/R; V = supply − ohm·Σ u·i is linear in V.
                let (mut slope, mut idle) = (0.0, 0.0);
                for (i, ((u, wheel), axis)) in acting.iter().zip(&self.wheels).zip(&self.axes).enumerate() {
                    let per_torque = self.current_per_torque / (1.0 + d.wheel(i).torque_constant);
                    let conductance = axis.torque_per_volt * per_torque;
                    let back_emf = axis.damping * wheel.speed * per_torque;
                    slope += u * u * conductance;
                    idle += u * back_emf;
                }
                supply = ((supply + ohm * idle) / (1.0 + ohm * slope)).max(0.0);
            }
        }
        let deviations = self.deviations.as_deref();
        let [coasting, drop_v, limit_a] =
            deviations.map_or([0.0; 3], |d| [d.coasting, d.bridge_drop_v, d.current_limit_a]);
        for (i, ((wheel, axis), u)) in self.wheels.iter_mut().zip(&self.axes).zip(&acting).enumerate() {
            let open = coasting * (1.0 - u.abs()) * axis.damping * wheel.speed;
            wheel.drive = axis.winding_torque(u * supply, 0.0) + open;
            if drop_v > 0.0 {
                let dropped = axis.winding_torque(drop_v, 0.0);
                wheel.drive -= (wheel.drive - axis.damping * wheel.speed).clamp(-dropped, dropped);
            }
            if limit_a > 0.0 {
                let own = 1.0 + deviations.map_or(0.0, |d| d.wheel(i).torque_constant);
                let (asked, most) = (wheel.drive - axis.damping * wheel.speed, limit_a * own / self.current_per_torque);
                wheel.drive -= asked - asked.clamp(-most, most);
            }
        }
        self.acting = acting;
    }
}

/// Replaces duties by those `ticks` ago, 0 before the first.
fn delay(queue: &mut Delayed, duty: &mut [f64], ticks: f64) {
    if ticks <= 0.0 {
        return;
    }
    let (whole, share) = (ticks.floor() as usize, ticks.fract());
    queue.push_back(duty.to_vec());
    while queue.len() > whole + 2 {
        queue.pop_front();
    }
    let at = |age: usize, i: usize| queue.len().checked_sub(1 + age).map_or(0.0, |k| queue[k][i]);
    for (i, u) in duty.iter_mut().enumerate() {
        *u = (1.0 - share) * at(whole, i) + share * at(whole + 1, i);
    }
}
