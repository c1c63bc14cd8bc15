//! The EAM-like solid of written functions against the laws that it contains.

use peridyne::law::potential::Described;
use peridyne::law::potential::mei::EamForm;
use peridyne::run::{Options, Simulation, build};
use peridyne::spec::AnyLinearBody;
use peridyne_io::deck::Deck;

fn deck(text: &str) -> Deck {
    Deck::parse(text, "deck.toml", &[]).unwrap_or_else(|e| panic!("{e} {:?}\n{text}", e.help))
}

fn made(text: &str) -> Box<dyn Simulation> {
    let options = Options {
        trust_time_step: true,
        ..Options::default()
    };
    build(&deck(text).spec, options).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Displacements without order, up to `size` along each axis of D.
fn noise(points: usize, d: usize, size: f64) -> Vec<[f64; 3]> {
    let step = [
        0.618_033_988_749_895,
        0.414_213_562_373_095,
        0.732_050_807_568_877,
    ];
    let of = |k: usize, a: usize| 2.0 * size * (((k + 1) as f64 * step[a]).fract() - 0.5);
    (0..points)
        .map(|k| std::array::from_fn(|a| if a < d { of(k, a) } else { 0.0 }))
        .collect()
}

fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let each = || a.as_flattened().iter().zip(b.as_flattened());
    let off = each().fold(0.0f64, |m, (x, y)| m.max((x - y).abs()));
    off / each().fold(0.0f64, |m, (_, y)| m.max(y.abs()))
}

/// What the bonds store beyond the reference (energy).
fn stored(sim: &mut dyn Simulation, u: &[[f64; 3]]) -> f64 {
    let mut of = |u: &[[f64; 3]]| {
        sim.set_displacements(u);
        let volume = sim.scalars("volume");
        let density = sim.scalars("energy_density");
        density.iter().zip(&volume).map(|(e, v)| e * v).sum::<f64>()
    };
    of(u) - of(&vec![[0.0; 3]; u.len()])
}

fn block(law: &str, family: &str, d: usize) -> String {
    let (lattice, axes, cells) = match d {
        1 => ("chain", "\"x\"", "[12]"),
        2 => ("square", "\"x\", \"y\"", "[9, 9]"),
        _ => ("cubic", "\"x\", \"y\", \"z\"", "[7, 7, 7]"),
    };
    format!(
        "units = \"none\"\nconstants = {{ K = 1.7, G = 0.8 }}\nhorizon = {{ m_ratio = 2 }}\ninfluence = \"inverse\"\n\
         family = \"{family}\"\nperiodic = [{axes}]\nbody = {{ lattice = \"{lattice}\", spacing = 0.1, cells = {cells} }}\n\
         [material]\ndensity = 1\nlaw = {law}\n[run]\nsteps = 1\ntime_step = 1e-3\n"
    )
}

/// (A.14)–(A.16): j = ω|ξ| r, κ = 30 G/m j s and the quadratic E make lps, forces, energy and tangents.
#[test]
fn the_linear_solid_is_embedded() {
    let lps = "{ lps = { bulk = \"K\", shear = \"G\" } }";
    let embedded = "{ embedded_solid = { energy = \"(3*K - 5*G)/theta0*(1.5*theta^2/theta0 - 3*theta)\", \
                    weight = \"omega*r0*r\", pair = \"15*G*omega*(r - r0)^2/theta0\", bulk = \"K\" } }";
    let u = noise(343, 3, 0.004);
    for family in ["stencil", "list"] {
        let [mut found, mut exact] = [embedded, lps].map(|law| made(&block(law, family, 3)));
        let off = apart(&found.forces_under(&u), &exact.forces_under(&u));
        assert!(off < 1e-12, "{family}: {off:e}");
        let energies = [&mut found, &mut exact].map(|sim| stored(sim.as_mut(), &u));
        assert!(
            (energies[0] / energies[1] - 1.0).abs() < 1e-12,
            "{energies:?}"
        );
        let [AnyLinearBody::Three(found), AnyLinearBody::Three(exact)] =
            [found.linear_body(), exact.linear_body()]
        else {
            panic!("three dimensions")
        };
        let largest = |all: &[[[f64; 3]; 3]]| {
            all.iter()
                .flatten()
                .flatten()
                .fold(0.0f64, |m, x| m.max(x.abs()))
        };
        let scale = largest(&exact.block);
        for i in 0..exact.points() {
            for j in (0..exact.points()).filter(|j| *j != i) {
                let zero = [[0.0; 3]; 3];
                let [a, b] = [&found, &exact].map(|of| *of.micromodulus(i, j).unwrap_or(&zero));
                for n in 0..9 {
                    let off = (a[n / 3][n % 3] - b[n / 3][n % 3]).abs();
                    assert!(off < 1e-12 * scale, "{i} {j}: {off:e}");
                }
            }
        }
    }
}

/// (4.10) as (A.24): j = |ξ|^(1−p) r, E = c/2 (ϑ/ϑ₀ − 1)², w = k/(2ϑ₀) |ξ|^−p e², for p = 2, where `eam_like` has ω = |ξ|^−2.
#[test]
fn structured_atoms_are_embedded() {
    let of = |law: &str| block(law, "stencil", 2).replace("\"inverse\"", "\"r^-2\"");
    let mut exact = made(&of("{ eam_like = { pair = 3, volume = 0.4 } }"));
    let mut found = made(&of(
        "{ embedded_solid = { energy = \"0.6*(theta/theta0 - 1)^2\", weight = \"r/r0\", \
         pair = \"1.5*(r - r0)^2/(r0^2*theta0)\", bulk = 1 } }",
    ));
    let u = noise(81, 2, 0.004);
    let off = apart(&found.forces_under(&u), &exact.forces_under(&u));
    assert!(off < 1e-12, "{off:e}");
}

/// g of (3.9) at the distance `r`.
fn switch(form: &EamForm, r: &str) -> String {
    let [near, cutoff] = [form.near, form.cutoff].map(|x| x * form.nearest);
    let x = format!("min(max(({r} - {near})/{}, 0), 1)", cutoff - near);
    format!("(1 - {x})^3*(1 + 3*{x} + 6*({x})^2)")
}

/// (A.22), (A.23): the functions (3.6)–(3.8) of atoms of this volume as those of a solid.
fn functions(form: &EamForm, volume: f64) -> [String; 3] {
    let density: Vec<String> = (form.density.iter().enumerate())
        .map(|(l, c)| format!("({c})*({}/r)^{l}", form.nearest * form.density_length))
        .collect();
    let weight = format!(
        "{}/{volume}*({})*{}",
        form.density_scale,
        density.join(" + "),
        switch(form, "r")
    );
    let x = format!("(r/{} - 1)", form.nearest * form.pair_length);
    let pair = format!(
        "-({})/{volume}^2*(1 + {}*{x})*exp(-{}*{x})*{}",
        form.pair,
        form.lambda,
        form.gamma,
        switch(form, "r")
    );
    let a = form.alpha / form.beta;
    let mut energy = format!("-{}*(1 - {a}*ln(theta))*theta^{a}", form.cohesive);
    for (count, distance) in &form.shells {
        let p = distance * form.shell_scale;
        let decay = format!(
            "exp({}*ln(theta) - {})",
            p * form.gamma / form.beta,
            (p - 1.0) * form.gamma
        );
        let line = format!(
            "({} - {}*ln(theta))",
            1.0 + (p - 1.0) * form.lambda,
            p * form.lambda / form.beta
        );
        let place = format!("{}*(1 - ln(theta)/{})", distance * form.nearest, form.beta);
        energy += &format!(
            " + {}*{line}*{decay}*{}",
            0.5 * form.pair * count,
            switch(form, &place)
        );
    }
    [format!("({energy})/{volume}"), weight, pair]
}

/// Forces and energy of embedded atoms on the neighbours that they have in their lattice, and of the solid of their functions.
fn compared(head: &str, form: &str, volume: f64, d: usize, size: f64) {
    let of = |law: &str| {
        format!("{head}\n[material]\ndensity = 1\n{law}\n[run]\nsteps = 1\ntime_step = 0.001\n")
    };
    let atoms = of(&format!("[material.law.eam_form]\n{form}"));
    let spec = deck(&atoms).spec;
    let potential = spec.potential().unwrap();
    let read = EamForm::read(&potential.parameters).unwrap();
    let [energy, weight, pair] = functions(&read, volume);
    let mut solid = made(&of(&format!(
        "[material.law.embedded_solid]\nenergy = \"{energy}\"\nweight = \"{weight}\"\npair = \"{pair}\"\nbulk = 1"
    )));
    let mut atoms = made(&atoms);
    let u = noise(atoms.info().points as usize, d, size);
    let [found, exact] = [&mut solid, &mut atoms].map(|sim| sim.forces_under(&u));
    let off = apart(&found, &exact);
    assert!(off < 1e-11, "{off:e}");
    let energies = [&mut solid, &mut atoms].map(|sim| stored(sim.as_mut(), &u));
    assert!(
        (energies[0] / energies[1] - 1.0).abs() < 1e-9,
        "{energies:?}"
    );
}

/// The chain of seleson2014, Fig. 1, for h = 1 and 4.
#[test]
fn the_chain_of_atoms_is_a_solid() {
    for h in [1.0, 4.0] {
        let head = format!(
            "units = \"none\"\nfamily = \"stencil\"\nhorizon = {{ m_ratio = 5 }}\ncontact = false\npartial_volume_correction = false\n\
             periodic = [\"x\"]\nbody = {{ lattice = \"chain\", spacing = {h}, origin = 0, cells = [40] }}"
        );
        let form = format!(
            "cohesive = {}\npair = {}\nalpha = 5.082\nbeta = 5.85\ngamma = 6.82054\nlambda = 12.06\n\
             density = [0.14095, -1.93222, 9.60043, -21.23718, 20.18581, -5.81656]\ndensity_scale = \"1/12\"\n\
             pair_length = 2\ndensity_length = 1\nshell_scale = 1\nnear = 3.5\ncutoff = 3.9",
            3.54 * h,
            0.1217 * h
        );
        compared(&head, &form, h, 1, 0.08 * h);
    }
}

/// The same functions with one length, for what they were made: copper, face-centred cubic.
#[test]
fn a_crystal_of_copper_is_a_solid() {
    let a = 3.6147;
    let head = format!(
        "units = \"none\"\nfamily = \"stencil\"\nhorizon = {{ m_ratio = 2 }}\ncontact = false\npartial_volume_correction = false\n\
         periodic = [\"x\", \"y\", \"z\"]\nbody = {{ lattice = \"fcc\", spacing = {a}, cells = [5, 5, 5] }}"
    );
    let form = "cohesive = 3.54\npair = 0.1217\nalpha = 5.082\nbeta = 5.85\ngamma = 6.82054\nlambda = 12.06\n\
                density = [0.14095, -1.93222, 9.60043, -21.23718, 20.18581, -5.81656]\ndensity_scale = \"1/12\"\n\
                near = 1.75\ncutoff = 1.95";
    compared(&head, form, a * a * a / 4.0, 3, 0.03 * a);
}
