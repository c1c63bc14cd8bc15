//! A list whose periodic images are points of their own: a homogeneous strain moves an image otherwise than what it copies.

use super::ListInteraction;
use super::kernel::View;
use crate::execute::blocks::Seen;
use crate::family::horizon::HorizonList;
use crate::law::Law;
use std::collections::HashMap;

/// The rows of a list, partners across a periodic face replaced by images behind the last slot.
pub struct Images {
    list: HorizonList,
    /// `[slots and images][4]`: x, y, z, volume.
    pub reference: Vec<f64>,
    /// `[slots and images][2]`, empty where the law has none.
    fields: Vec<f64>,
    /// `[slots and images]`, empty where materials do not matter.
    materials: Vec<u8>,
}

impl Images {
    pub fn new<const D: usize, W: Law>(of: &ListInteraction<D, W>) -> Images {
        let family = &of.bonds.family;
        let mut made = Images {
            list: family.list.clone(),
            reference: family.reference.clone(),
            fields: of.fields.clone(),
            materials: of.bonds.material.clone(),
        };
        if !family.is_periodic() {
            return made;
        }
        let view = of.view(of.moved());
        let mut known: HashMap<(usize, [i64; D]), u32> = HashMap::new();
        of.each_line(|place, _, [i, j]| {
            let x = |slot: usize| &family.reference[4 * slot..][..4];
            let (xi, _) = view.constant(i, j);
            // periods from j to the image that i sees
            let shift: [f64; D] = crate::array::from_fn(|a| xi[a] - (x(j)[a] - x(i)[a]));
            let turns = crate::array::from_fn(|a| (shift[a] * family.inv_period[a]).round() as i64);
            if turns == [0; D] {
                return;
            }
            made.list.partner[place] = *known.entry((j, turns)).or_insert_with(|| {
                let mut image = [0.0; 4];
                image.copy_from_slice(x(j));
                for a in 0..D {
                    image[a] += turns[a] as f64 * family.period[a];
                }
                let slot = made.reference.len() / 4;
                made.reference.extend(image);
                let fields = of.fields.get(2 * j..2 * j + 2);
                made.fields.extend_from_slice(fields.unwrap_or(&[]));
                made.materials.extend(of.bonds.material.get(j).copied());
                slot as u32
            });
        });
        made
    }

    /// `moved` for slots and images.
    pub fn view<'a, const D: usize, W: Law>(
        &'a self,
        of: &'a ListInteraction<D, W>,
        moved: &'a [f64],
    ) -> View<'a, D, W> {
        View {
            list: &self.list,
            reference: &self.reference,
            fields: Seen(self.fields.as_ptr()),
            materials: &self.materials,
            periodic: false,
            ..of.view(moved)
        }
    }
}
