use super::*;
use hdf5_reader::Hdf5File;

#[test]
fn somebody_else_reads_what_is_written() {
    let made = |piece: u64, length: u64| {
        let mut head = Head::new();
        let mut dataset = |number, dimensions: &[u64], storage, links| {
            head.dataset(&Dataset {
                number,
                dimensions,
                storage,
                attributes: &[("Attribute", Attribute::Text("Scalars"))],
                links,
            })
        };
        let floats = dataset(Number::F64, &[2], Storage::Piece(piece), 2);
        let bytes = dataset(Number::U8, &[3], Storage::Piece(piece + 16), 1);
        let ones = dataset(Number::I64, &[70, 2], Storage::All(1), 1);
        let attributes = [
            ("Version", Attribute::Many(&[2, 0])),
            ("NSteps", Attribute::One(-7)),
        ];
        let children = [("floats", floats), ("again", floats), ("bytes", bytes)];
        let group = head.group(&attributes, &children);
        let root = head.group(&[], &[("group", group), ("ones", ones)]);
        head.finish(root, length)
    };
    let start = made(0, 0).len() as u64;
    let mut file = made(start, start + 19);
    file.extend([1.5f64, -0.0].iter().flat_map(|x| x.to_le_bytes()));
    file.extend([7, 8, 255]);
    let file = Hdf5File::from_vec(file).unwrap();
    for name in ["group/floats", "group/again"] {
        let floats = file.dataset(name).unwrap();
        assert_eq!(
            floats.read_array::<f64>().unwrap().as_slice().unwrap(),
            [1.5, 0.0]
        );
        assert_eq!(
            floats
                .attribute("Attribute")
                .unwrap()
                .read_string()
                .unwrap(),
            "Scalars"
        );
    }
    let bytes = file.dataset("group/bytes").unwrap();
    assert_eq!(
        bytes.read_array::<u8>().unwrap().as_slice().unwrap(),
        [7, 8, 255]
    );
    let ones = file.dataset("ones").unwrap();
    assert_eq!(ones.shape(), [70, 2]);
    assert_eq!(ones.max_dims(), Some(&[u64::MAX, 2][..]));
    assert!(ones.read_array::<i64>().unwrap().iter().all(|x| *x == 1));
    let group = file.group("group").unwrap();
    let version = group.attribute("Version").unwrap();
    assert_eq!(version.read_1d::<i64>().unwrap(), [2, 0]);
    assert_eq!(
        group
            .attribute("NSteps")
            .unwrap()
            .read_scalar::<i64>()
            .unwrap(),
        -7
    );
}

/// A node as its bytes say it: level, siblings, and where its children begin and are.
struct Node {
    level: u8,
    beside: [u64; 2],
    children: Vec<(u64, u64)>,
    end: u64,
}

fn node(bytes: &[u8], chunks: &Chunks) -> Node {
    let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
    assert_eq!(&bytes[..5], b"TREE\x01");
    assert_eq!(bytes.len() as u64, chunks.node());
    let count = u16::from_le_bytes([bytes[6], bytes[7]]) as usize;
    let key = 8 + 8 * (chunks.rank as usize + 1);
    let at = |n: usize| 24 + n * (key + 8);
    assert!(bytes[at(count) + key..].iter().all(|b| *b == 0));
    Node {
        level: bytes[5],
        beside: [word(8), word(16)],
        children: (0..count)
            .map(|n| (word(at(n) + 8), word(at(n) + key)))
            .collect(),
        end: word(at(count) + 8),
    }
}

#[test]
fn every_chunk_is_found_from_the_root() {
    let chunks = Chunks {
        rank: 2,
        rows: 5,
        bytes: 120,
    };
    let mut tree = Tree::default();
    let mut end = 1000;
    assert_eq!(tree.root(0), NOWHERE);
    // what is in the file, written as a file that grows writes it
    let mut file = std::collections::BTreeMap::new();
    let mut count = 0;
    for by in [1, 62, 1, 1, 63, 3000, 968, 1, 400] {
        tree.grow(by, || {
            end += 10;
            end
        });
        for which in tree.changed(count) {
            let (at, bytes) = tree.node(which, &chunks, 7, |chunk| 1_000_000 + chunk);
            file.insert(at, bytes);
        }
        count += by;
        let mut level = vec![tree.root(7)];
        let mut depth = 0;
        loop {
            let nodes: Vec<Node> = level.iter().map(|at| node(&file[at], &chunks)).collect();
            let mut beside = vec![NOWHERE];
            beside.extend(&level);
            beside.push(NOWHERE);
            for (k, n) in nodes.iter().enumerate() {
                assert_eq!(n.beside, [beside[k], beside[k + 2]], "{count} chunks");
                let next = nodes.get(k + 1).map_or(5 * count, |n| n.children[0].0);
                assert_eq!(n.end, next);
            }
            let leaves = nodes[0].level == 0;
            let children: Vec<(u64, u64)> = nodes.into_iter().flat_map(|n| n.children).collect();
            level = children.iter().map(|c| c.1).collect();
            depth += 1;
            if leaves {
                let all: Vec<(u64, u64)> = (0..count).map(|c| (5 * c, 1_000_000 + c)).collect();
                assert_eq!(children, all);
                break;
            }
        }
        assert_eq!(depth, [64, 4096].iter().filter(|n| count > **n).count() + 1);
    }
}
