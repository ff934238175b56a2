//! The labelled estimates of `--simulate`.

use super::evidence::{Evidence, LeftOut, asked_provenance, shortened};
use super::{CalibrateArguments, MasksArgument};
use crate::cli::failure::Failure;
use crate::cli::object::check_diameter;
use crate::cli::report::plural;
use crate::cli::terminal::Terminal;
use cobra_infer::Template;
use cobra_infer::depth::DepthSettings;
use cobra_infer::template::{CalibrationSource, DecodedTerm};
use cobra_train::bop::render::DepthNoise;
use cobra_train::depth::template_surface;
use cobra_train::progress::Progress;
use cobra_train::simulation::{Simulation, SimulationError, simulate};
use cobra_train::surface::read_mesh;

pub(super) fn evidence(
    arguments: &CalibrateArguments,
    template: &Template<'_>,
    count: u32,
    terminal: &Terminal,
) -> Result<Evidence, Failure> {
    let refuse = |error: SimulationError| {
        Failure::BadInput(format!("{}: {error}", arguments.template.display()))
    };
    let mesh = arguments.mesh.as_deref().map(read_mesh).transpose()?;
    if let (Some(mesh), Some(path)) = (&mesh, &arguments.mesh) {
        check_diameter(template, mesh.diameter(), path)?;
    }
    let mut room = vec![DecodedTerm::default(); template.decoded_len()];
    let decoded = template.decoded(&mut room);
    let template = decoded.as_ref().unwrap_or(template);
    let settings = DepthSettings {
        minimum_points: arguments.min_points,
        ..DepthSettings::for_template(template)
    };
    let surface = template_surface(template, &settings).map_err(|error| refuse(error.into()))?;
    let sensor = arguments.depth_noise.unwrap_or(DepthNoise::MILLIMETRES);
    let masked = arguments.masks == MasksArgument::Simulated;
    let simulation = Simulation {
        estimates: count as usize,
        noise: sensor / f64::from(template.unit().millimetres()),
        masked,
        symmetric: arguments.symmetric,
        seed: arguments.seed,
    };
    terminal.start("simulating estimates", 1);
    let found = simulate(&surface, mesh.as_ref(), &settings, &simulation).map_err(refuse)?;
    terminal.finish();
    let known = found
        .iter()
        .filter(|one| one.valid_pixels >= arguments.min_points);
    let labelled: Vec<_> = known.map(|one| one.labelled).collect();
    let too_few_pixels = found.len() - labelled.len();
    if too_few_pixels > 0 {
        let estimates = plural(too_few_pixels, "estimate");
        terminal.say(&format!("{estimates} with too few valid pixels left out"));
    }
    let seen = if mesh.is_some() {
        "mesh"
    } else {
        "own surface"
    };
    let pixels = if masked { "mask" } else { "silhouette" };
    Ok(Evidence {
        labelled,
        left_out: LeftOut {
            too_few_pixels,
            ..LeftOut::default()
        },
        source: CalibrationSource::Simulated,
        provenance: match asked_provenance(arguments)? {
            Some(text) => text,
            None => shortened(format!("{seen}, {pixels}, {sensor} mm")),
        },
    })
}
