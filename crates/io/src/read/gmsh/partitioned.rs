//! Entities of a mesh that gmsh cut into partitions (format 4.1): their cells are in the groups of the entities that they were cut from.

use super::bytes::Bytes;
use super::{Gmsh, end};
use crate::read::error::ReadError;
use crate::read::lines::Lines;
use std::collections::BTreeSet;

/// Part of an entity.
struct Part {
    dimension: usize,
    tag: i64,
    /// Dimension and tag of what it was cut from.
    parent: (i64, i64),
    partitions: Vec<u64>,
    groups: Vec<i32>,
}

/// Partitions that the file says it has, and those that are there.
#[derive(Default)]
struct Partitions {
    count: u64,
    there: BTreeSet<u64>,
}

impl Partitions {
    fn add(&mut self, mesh: &mut Gmsh, part: Part) {
        let own = mesh.groups(part.dimension, &part.groups);
        let parent = (part.dimension, part.parent.1);
        let alike = part.parent.0 == part.dimension as i64;
        let parent = mesh.entities.get(&parent).filter(|_| alike).cloned();
        let mut groups = parent.unwrap_or_default();
        groups.extend(
            own.iter()
                .filter(|g| !groups.contains(g))
                .collect::<Vec<_>>(),
        );
        mesh.entities.insert((part.dimension, part.tag), groups);
        // what lies between partitions is of several
        if let [one] = part.partitions[..] {
            self.there.insert(one);
        }
    }

    fn whole(&self, lines: &Lines) -> Result<(), ReadError> {
        if self.there.len() as u64 >= self.count {
            return Ok(());
        }
        let there: Vec<String> = self.there.iter().map(u64::to_string).collect();
        Err(lines.error(format!(
            "the file has partition {} of {}: save the whole mesh in one file (Mesh.PartitionSplitMeshFiles = 0), or without partitions",
            there.join(", "),
            self.count
        )))
    }
}

pub(super) fn text(lines: &mut Lines, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let line = lines.expect("the number of partitions")?;
    let mut partitions = Partitions {
        count: lines.parse(Some(line), "the number of partitions")?,
        ..Partitions::default()
    };
    let line = lines.expect("the number of ghost entities")?;
    let ghosts: usize = lines.parse(Some(line), "the number of ghost entities")?;
    for _ in 0..ghosts {
        lines.expect("a ghost entity")?;
    }
    let line = lines.expect("the numbers of entities")?;
    let counts: Vec<usize> = line
        .split_whitespace()
        .map(|f| lines.parse(Some(f), "a number of entities"))
        .collect::<Result<_, _>>()?;
    for (dimension, count) in counts.into_iter().enumerate().take(4) {
        for _ in 0..count {
            let line = lines.expect("an entity")?;
            let mut fields = line.split_whitespace();
            let tag = lines.parse(fields.next(), "the tag of an entity")?;
            let above = lines.parse(fields.next(), "the dimension of its parent")?;
            let parent = (above, lines.parse(fields.next(), "the tag of its parent")?);
            let count: usize = lines.parse(fields.next(), "its number of partitions")?;
            let own = (0..count.min(line.len())).map(|_| lines.parse(fields.next(), "a partition"));
            let own = own.collect::<Result<_, _>>()?;
            // a point has coordinates, the others a bounding box
            let mut fields = fields.skip(if dimension == 0 { 3 } else { 6 });
            let count: usize = lines.parse(fields.next(), "the number of physical groups")?;
            let groups =
                (0..count.min(line.len())).map(|_| lines.parse(fields.next(), "a physical group"));
            let part = Part {
                dimension,
                tag,
                parent,
                partitions: own,
                groups: groups.collect::<Result<_, _>>()?,
            };
            partitions.add(mesh, part);
        }
    }
    partitions.whole(lines)?;
    end(lines, "$EndPartitionedEntities")
}

pub(super) fn binary(file: &mut Bytes, mesh: &mut Gmsh) -> Result<(), ReadError> {
    let mut partitions = Partitions {
        count: file.size("the number of partitions")?,
        ..Partitions::default()
    };
    for _ in 0..file.size("the number of ghost entities")? {
        file.take(8, "a ghost entity")?;
    }
    let mut counts = [0; 4];
    for count in &mut counts {
        *count = file.size("a number of entities")?;
    }
    for (dimension, count) in counts.into_iter().enumerate() {
        for _ in 0..count {
            let tag = i64::from(file.int("the tag of an entity")?);
            let above = i64::from(file.int("the dimension of its parent")?);
            let parent = (above, i64::from(file.int("the tag of its parent")?));
            let mut own = vec![];
            for _ in 0..file.size("its number of partitions")? {
                own.push(file.unsigned("a partition")?);
            }
            // a point has coordinates, the others a bounding box
            let place = if dimension == 0 { 24 } else { 48 };
            file.take(place, "the place of an entity")?;
            let mut groups = vec![];
            for _ in 0..file.size("the number of physical groups")? {
                groups.push(file.int("a physical group")?);
            }
            if dimension > 0 {
                for _ in 0..file.size("the number of bounding entities")? {
                    file.int("a bounding entity")?;
                }
            }
            let part = Part {
                dimension,
                tag,
                parent,
                partitions: own,
                groups,
            };
            partitions.add(mesh, part);
        }
    }
    partitions.whole(&file.lines)
}
