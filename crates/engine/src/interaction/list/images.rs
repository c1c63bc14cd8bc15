//! A list whose periodic images are points of their own: a homogeneous strain moves an image otherwise than what it copies.

use super::ListInteraction;
use super::kernel::View;
use crate::execute::blocks::Seen;
use crate::execute::lane::TILE;
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
        let mut made = Images {
            list: of.list.clone(),
            reference: of.reference.clone(),
            fields: of.fields.clone(),
            materials: of.materials.clone(),
        };
        if !of.is_periodic() {
            return made;
        }
        let view = of.view(&of.moved);
        let mut known: HashMap<(u32, [i64; D]), u32> = HashMap::new();
        for (row, &i) in of.list.rows.iter().enumerate() {
            for line in of.list.lines(row) {
                let place = line * TILE + row % TILE;
                let j = of.list.partner[place];
                if j == i {
                    continue;
                }
                let x = |slot: u32| &of.reference[4 * slot as usize..][..4];
                let (xi, _) = view.constant(i as usize, j as usize);
                // periods from j to the image that i sees
                let shift: [f64; D] = std::array::from_fn(|a| xi[a] - (x(j)[a] - x(i)[a]));
                let turns = std::array::from_fn(|a| (shift[a] * of.inv_period[a]).round() as i64);
                if turns == [0; D] {
                    continue;
                }
                made.list.partner[place] = *known.entry((j, turns)).or_insert_with(|| {
                    let mut image = [0.0; 4];
                    image.copy_from_slice(x(j));
                    for a in 0..D {
                        image[a] += turns[a] as f64 * of.period[a];
                    }
                    let slot = made.reference.len() / 4;
                    made.reference.extend(image);
                    made.fields.extend_from_slice(
                        of.fields
                            .get(2 * j as usize..2 * j as usize + 2)
                            .unwrap_or(&[]),
                    );
                    made.materials.extend(of.materials.get(j as usize).copied());
                    slot as u32
                });
            }
        }
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
