//! Keywords of `thermo_style custom`, which formulas know too.

/// `(keyword, heading, is an integer)`
const KEYWORDS: [(&str, &str, bool); 44] = [
    ("step", "Step", true),
    ("elapsed", "Elapsed", true),
    ("elaplong", "Elaplong", true),
    ("dt", "Dt", false),
    ("time", "Time", false),
    ("cpu", "CPU", false),
    ("tpcpu", "T/CPU", false),
    ("spcpu", "S/CPU", false),
    ("cpuremain", "CPULeft", false),
    ("atoms", "Atoms", true),
    ("temp", "Temp", false),
    ("press", "Press", false),
    ("pxx", "Pxx", false),
    ("pyy", "Pyy", false),
    ("pzz", "Pzz", false),
    ("pxy", "Pxy", false),
    ("pxz", "Pxz", false),
    ("pyz", "Pyz", false),
    ("pe", "PotEng", false),
    ("ke", "KinEng", false),
    ("etotal", "TotEng", false),
    ("evdwl", "E_vdwl", false),
    ("ecoul", "E_coul", false),
    ("epair", "E_pair", false),
    ("ebond", "E_bond", false),
    ("eangle", "E_angle", false),
    ("edihed", "E_dihed", false),
    ("eimp", "E_impro", false),
    ("emol", "E_mol", false),
    ("elong", "E_long", false),
    ("enthalpy", "Enthalpy", false),
    ("vol", "Volume", false),
    ("lx", "Lx", false),
    ("ly", "Ly", false),
    ("lz", "Lz", false),
    ("xlo", "Xlo", false),
    ("xhi", "Xhi", false),
    ("ylo", "Ylo", false),
    ("yhi", "Yhi", false),
    ("zlo", "Zlo", false),
    ("zhi", "Zhi", false),
    ("xy", "Xy", false),
    ("xz", "Xz", false),
    ("yz", "Yz", false),
];

pub fn names() -> impl Iterator<Item = &'static str> {
    KEYWORDS.iter().map(|(n, _, _)| *n)
}

pub fn find(name: &str) -> Option<&'static str> {
    names().find(|n| *n == name)
}

/// Heading of a column.
pub fn heading(name: &str) -> &'static str {
    KEYWORDS
        .iter()
        .find(|(n, _, _)| *n == name)
        .map_or("", |(_, h, _)| h)
}

pub fn is_integer(name: &str) -> bool {
    KEYWORDS.iter().any(|(n, _, i)| *n == name && *i)
}

/// Keywords whose values add up over atoms: divided by their number with `thermo_modify norm yes`.
pub fn is_extensive(name: &str) -> bool {
    matches!(
        name,
        "pe" | "ke"
            | "etotal"
            | "evdwl"
            | "ecoul"
            | "epair"
            | "ebond"
            | "emol"
            | "elong"
            | "enthalpy"
    )
}
