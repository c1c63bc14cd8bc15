//! Which points, of lists of those of all ranks, a rank has.

/// A list of points of all ranks, by their ids; `None`: all points in order.
#[derive(Debug, Clone, Default)]
pub(super) struct Listed {
    ids: Option<Vec<u32>>,
    /// Places in it of the points that are here.
    pub places: Vec<usize>,
}

impl Listed {
    /// `own`: ids of the points that are here, in order.
    pub fn new(ids: Option<Vec<u32>>, own: &[u32]) -> Listed {
        let places = match &ids {
            None => own.iter().map(|id| *id as usize).collect(),
            Some(ids) => {
                let here = |(_, id): &(usize, &u32)| own.binary_search(id).is_ok();
                { ids.iter().enumerate() }
                    .filter(here)
                    .map(|(n, _)| n)
                    .collect()
            }
        };
        Listed { ids, places }
    }

    /// Those of these points that are here, by their ids here; `None`: all of them.
    pub fn here(&self, own: &[u32]) -> Option<Vec<u32>> {
        let ids = self.ids.as_ref()?;
        let place = |n: &usize| own.binary_search(&ids[*n]).ok().map(|id| id as u32);
        Some(self.places.iter().filter_map(place).collect())
    }

    /// Without these points, whose ids are in order: those above theirs move down. `own` are those of afterwards.
    pub fn without(&self, gone: &[u32], own: &[u32]) -> Listed {
        let left = |id: &u32| match gone.binary_search(id) {
            Ok(_) => None,
            Err(below) => Some(id - below as u32),
        };
        let ids = self.ids.as_ref();
        Listed::new(ids.map(|ids| ids.iter().filter_map(left).collect()), own)
    }
}

/// The lists of those who lead a model.
#[derive(Debug, Clone, Default)]
pub(super) struct Here {
    pub kinematic: Listed,
    /// Of each driven condition.
    pub driven: Vec<Listed>,
}

#[cfg(test)]
mod tests {
    use super::Listed;

    #[test]
    fn places_follow_points_that_are_taken_away() {
        let own = [2, 3, 5, 8];
        let listed = Listed::new(Some(vec![8, 1, 3, 9]), &own);
        assert_eq!(listed.places, [0, 2]);
        assert_eq!(listed.here(&own), Some(vec![3, 1]));
        // of 2, 5, 8 that are left 1, 3, 6 are here
        let own = [1, 3, 6];
        let left = listed.without(&[1, 3], &own);
        assert_eq!(
            (left.places.clone(), left.here(&own)),
            (vec![0], Some(vec![2]))
        );
        let all = Listed::new(None, &[2, 3, 5, 8]).without(&[1, 3], &own);
        assert_eq!((all.places.clone(), all.here(&own)), (vec![1, 3, 6], None));
    }
}
