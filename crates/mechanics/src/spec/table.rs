//! A potential in numbers.

/// Functions of an element of an embedded-atom model as tables, as eam/alloy, eam/fs and eam files hold them: values at `m Δρ` (F) and `m Δr`
/// (f and r φ), m = 0, 1, …, at least five each.
#[derive(Debug, Clone, PartialEq)]
pub struct TableSpec {
    /// Δρ.
    pub density_step: f64,
    /// F (energy).
    pub embedding: Vec<f64>,
    /// Δr (length).
    pub step: f64,
    /// f.
    pub density: Vec<f64>,
    /// r φ (energy · length).
    pub pair: Vec<f64>,
    /// Distance beyond which there is nothing (length).
    pub cutoff: f64,
    /// Name of the element.
    pub element: String,
    /// What its atoms have with those of other elements.
    pub partners: Vec<PartnerTable>,
}

/// Functions of a pair of unlike elements, on the same distances as those of the element itself.
#[derive(Debug, Clone, PartialEq)]
pub struct PartnerTable {
    /// The other one.
    pub element: String,
    /// Density that an atom of it adds at one of this.
    pub density: Vec<f64>,
    /// r φ (energy · length) between the two.
    pub pair: Vec<f64>,
}

impl TableSpec {
    /// Can splines be laid through it?
    ///
    /// # Errors
    /// What cannot.
    pub fn check(&self) -> Result<(), String> {
        for (name, values) in [
            ("the embedding energy", &self.embedding),
            ("the density", &self.density),
            ("the pair term", &self.pair),
        ] {
            if values.len() < 5 || values.iter().any(|v| !v.is_finite()) {
                return Err(format!(
                    "{name} needs a table of five or more finite values"
                ));
            }
        }
        if self.density.len() != self.pair.len() {
            return Err("density and pair term need tables of one length".into());
        }
        for partner in &self.partners {
            let fits = [&partner.density, &partner.pair]
                .iter()
                .all(|t| t.len() == self.pair.len() && t.iter().all(|v| v.is_finite()));
            if !fits {
                return Err(format!(
                    "density and pair term with {} need {} finite values",
                    partner.element,
                    self.pair.len()
                ));
            }
        }
        let positive = |x: f64| x > 0.0 && x.is_finite();
        match [self.density_step, self.step, self.cutoff]
            .into_iter()
            .all(positive)
        {
            true => Ok(()),
            false => Err("steps and cut-off must be positive".into()),
        }
    }

    /// The same model with lengths times `length` and energies times `energy`.
    pub fn scaled(&self, length: f64, energy: f64) -> TableSpec {
        let times = |values: &[f64], x: f64| values.iter().map(|v| v * x).collect();
        TableSpec {
            density_step: self.density_step,
            embedding: times(&self.embedding, energy),
            step: self.step * length,
            density: self.density.clone(),
            pair: times(&self.pair, energy * length),
            cutoff: self.cutoff * length,
            element: self.element.clone(),
            partners: { self.partners.iter() }
                .map(|p| PartnerTable {
                    element: p.element.clone(),
                    density: p.density.clone(),
                    pair: times(&p.pair, energy * length),
                })
                .collect(),
        }
    }
}
