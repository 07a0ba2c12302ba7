//! Impact factors of the midspan moment of a simple span under a lorry, speed by speed: `cargo run --release --example speeds`.

use spanwise::bridge::{Layout, Stations};
use spanwise::crossing::Preparation;
use spanwise::damping::Damping;
use spanwise::error::Error;
use spanwise::modes::Modes;
use spanwise::passage::Settings;
use spanwise::statics::{Flexibility, Quantity};
use spanwise::stop_token::StopToken;
use spanwise::vehicle::{Axle, Vehicle};

fn main() -> Result<(), Error> {
    let stop = StopToken::NEVER;
    let bridge = Layout::of_spans(&[20.0], 6e9, 8e3)?.stations(Stations::PerSpan(vec![8])).build()?;
    let modes = Modes::new(&bridge, &Flexibility::new(&bridge, &[])?, 3)?;
    let damped = Preparation::default().damping(Damping::Ratios(vec![0.02]));
    let analysis = damped.sections(&[10.0]).of(&bridge, modes, stop)?;
    let axle = |position: f64| Axle::new(position, 3.5e6, 1.5e6);
    let lorry = Vehicle::new(20e3, 80e3, 1.2, vec![axle(2.0), axle(-2.0)])?;
    println!("speed [m/s]   largest moment [kN m]   impact factor");
    for speed in [5.0, 10.0, 15.0, 20.0, 25.0, 30.0] {
        let crossed = analysis.cross(&lorry, &Settings::at_speed(speed), stop)?;
        let moments = analysis.envelope_of(&crossed, Quantity::Moment, StopToken::NEVER)?;
        let [dynamic, at_rest] = [&moments.dynamic, &moments.at_rest].map(|extremes| extremes.max[0].value);
        println!("{speed:11}   {:21.1}   {:13.4}", dynamic / 1e3, dynamic / at_rest);
    }
    Ok(())
}
