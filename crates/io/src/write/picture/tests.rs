use super::image::{Color, WHITE};
use super::*;
use crate::write::fields::tests::{of_columns, with};
use peridyne::observe::{Snapshot, Values};
use peridyne::state::Archive;

/// A lattice of nx × ny × nz points, spacing 1, all arrays zero.
fn block(n: [usize; 3], dimension: usize) -> Snapshot {
    let mut reference = Vec::new();
    for z in 0..n[2] {
        for y in 0..n[1] {
            reference.extend((0..n[0]).map(|x| [x as f64, y as f64, z as f64]));
        }
    }
    let count = reference.len();
    let columns = vec![
        ("displacement", Values::Vectors(vec![[0.0; 3]; count])),
        ("damage", Values::Scalars(vec![0.0; count])),
    ];
    Snapshot {
        dimension,
        spacing: 1.0,
        ..of_columns(reference, columns)
    }
}

/// Damaged where the reference position says so.
fn damaged(s: Snapshot, at: impl Fn(&[f64; 3]) -> bool) -> Snapshot {
    let damage = s.reference.iter().map(|x| f64::from(u8::from(at(x))));
    let damage = Values::Scalars(damage.collect());
    with(s, "damage", damage)
}

fn draw(s: &Snapshot) -> Image {
    picture(s, &[], &PictureOptions::default(), About::Fracture).unwrap()
}

fn number_of(image: &Image, color: Color) -> usize {
    image.pixels.iter().filter(|p| **p == color).count()
}

/// The part of a picture between head and foot.
fn views(image: &Image) -> Image {
    let rows = HEAD as usize..image.height - FOOT as usize;
    let pixels = image.pixels[rows.start * image.width..rows.end * image.width].to_vec();
    Image {
        height: rows.len(),
        pixels,
        ..*image
    }
}

#[test]
fn a_plate_shows_damage_where_it_is() {
    let s = damaged(block([20, 10, 1], 2), |x| x[0] > 9.5);
    let image = draw(&s);
    let row = (HEAD as usize + image.height - FOOT as usize) / 2;
    let at = |x: usize| image.pixels[row * image.width + x];
    assert_eq!(at(image.width / 4), colormap::color(0.0));
    assert_eq!(at(3 * image.width / 4), colormap::color(1.0));
    assert_eq!(at(5), WHITE);
}

#[test]
fn up_is_up() {
    let s = damaged(block([10, 10, 1], 2), |x| x[1] > 4.5);
    let image = views(&draw(&s));
    let at = |part: f64| {
        image.pixels[(part * image.height as f64) as usize * image.width + image.width / 2]
    };
    assert_eq!(at(0.25), colormap::color(1.0));
    assert_eq!(at(0.75), colormap::color(0.0));
}

#[test]
fn the_layer_nearest_to_the_viewer_wins() {
    // thin along y: seen from +y; the order of the points must not matter
    for flip in [false, true] {
        let mut s = block([30, 3, 30], 3);
        if flip {
            s.reference.reverse();
        }
        let s = damaged(s, |x| x[1] == 2.0);
        let image = views(&draw(&s));
        // the left view is the one from above
        let left: Vec<Color> = image
            .pixels
            .chunks(image.width)
            .flat_map(|row| row[..700].to_vec())
            .collect();
        assert!(left.contains(&colormap::color(1.0)));
        assert!(!left.contains(&colormap::color(0.0)));
    }
}

#[test]
fn the_section_shows_the_inside() {
    // a core that no view of the whole body could show
    let s = damaged(block([31, 31, 5], 3), |x| {
        (x[0] - 15.0).abs() < 5.0 && (x[1] - 15.0).abs() < 5.0 && (x[2] - 2.0).abs() < 1.5
    });
    let image = views(&draw(&s));
    let bright = |p: &&Color| p[0] > 200 && p[1] > 200 && p[2] < 200;
    let part = |range: std::ops::Range<usize>| {
        image
            .pixels
            .chunks(image.width)
            .map(|row| row[range.clone()].iter().filter(bright).count())
            .sum::<usize>()
    };
    assert_eq!(part(0..780), 0);
    assert!(part(820..1600) > 1000);
}

#[test]
fn debris_far_away_is_counted_and_does_not_shrink_the_picture() {
    let s = block([40, 40, 1], 2);
    let whole = draw(&s);
    let mut u = s.displacement().to_vec();
    u[0] = [1e9, 0.0, 0.0];
    u[1] = [f64::NAN, 0.0, 0.0];
    let broken = draw(&with(s, "displacement", Values::Vectors(u)));
    assert_eq!((whole.width, whole.height), (broken.width, broken.height));
    // two points of 1,600 are missing from the views, nothing else moved
    let lost = number_of(&views(&broken), WHITE) - number_of(&views(&whole), WHITE);
    let body = views(&whole).pixels.len() - number_of(&views(&whole), WHITE);
    assert!(
        (lost as f64 / body as f64 - 2.0 / 1600.0).abs() < 5e-4,
        "{lost} of {body}"
    );
    // and the foot says so
    let foot = |i: &Image| i.pixels[(i.height - FOOT as usize) * i.width..].to_vec();
    assert_ne!(foot(&whole), foot(&broken));
}

#[test]
fn a_long_bar_is_stacked_and_a_tower_fits() {
    let bar = draw(&block([100, 5, 3], 3));
    let ink = |image: &Image, x: usize| {
        let views = views(image);
        (0..views.height).any(|y| views.pixels[y * views.width + x] != WHITE)
    };
    assert!(ink(&bar, 100) && ink(&bar, 800) && ink(&bar, 1500));
    let tower = draw(&block([5, 200, 1], 2));
    assert!(tower.height <= 1600);
}

#[test]
fn bodies_without_extent_are_drawn() {
    for dimension in 1..=3 {
        for n in [0, 1] {
            let s = block([n, 1, 1], dimension);
            for s in [
                Snapshot {
                    spacing: 0.0,
                    ..s.clone()
                },
                s,
            ] {
                let image = draw(&s);
                assert!(image.width == 1600 && (200..2000).contains(&image.height));
                assert!(number_of(&image, INK) > 0);
            }
        }
    }
}

#[test]
fn a_chain_is_two_curves() {
    let s = damaged(block([50, 1, 1], 1), |x| x[0] == 25.0);
    let u = s.reference.iter().map(|x| [0.01 * x[0], 0.0, 0.0]);
    let u = Values::Vectors(u.collect());
    let s = with(s, "displacement", u);
    let image = draw(&s);
    // the damaged point, in both plots, in the colour of damage 1
    let hot: Vec<usize> = (0..image.pixels.len())
        .filter(|&i| image.pixels[i] == colormap::color(1.0))
        .collect();
    let upper = hot
        .iter()
        .filter(|&&i| i / image.width < (HEAD + 320.0) as usize)
        .count();
    assert!(upper > 20 && hot.len() - upper > 20);
}

#[test]
fn damage_must_be_there() {
    let s = with(block([3, 3, 1], 2), "damage", Values::Scalars(vec![]));
    let text = picture(&s, &[], &PictureOptions::default(), About::Fracture)
        .unwrap_err()
        .to_string();
    assert!(text.contains("no damage"), "{text}");
}

#[test]
fn the_file_is_a_png_of_the_picture() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("damage.png");
    let s = block([10, 10, 10], 3);
    let options = PictureOptions {
        title: "x".repeat(500),
        width: 900,
        ..PictureOptions::default()
    };
    write(&path, &s, &[], &options, About::Fracture).unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    assert_eq!(
        bytes,
        picture(&s, &[], &options, About::Fracture)
            .unwrap()
            .pixels
            .as_flattened()
    );
}

#[test]
fn a_level_surface_is_lit_evenly_up_to_its_edges() {
    let image = views(&draw(&block([20, 20, 20], 3)));
    // down the middle of the section: the top face, then the cut
    let column: Vec<Color> = image
        .pixels
        .chunks(image.width)
        .map(|row| row[1180])
        .collect();
    let first = column.iter().position(|p| *p != WHITE).unwrap();
    let top = &column[first + 2..first + 150];
    assert!(top.iter().all(|p| *p == top[0]));
    let cut = column[column.len() / 2];
    assert!(cut[0] < top[0][0] && cut[2] < top[0][2]);
}

/// Cells of unlike size beside each other: each as large as it is, none hides the other.
#[test]
fn a_place_shows_the_cell_that_it_lies_in() {
    let mut s = block([8, 8, 1], 2);
    let mut fine = vec![];
    for y in 0..16 {
        fine.extend((0..16).map(|x| [7.75 + 0.5 * x as f64, -0.25 + 0.5 * y as f64, 0.0]));
    }
    s.reference.extend(fine);
    let count = s.reference.len();
    let s = Snapshot {
        dimension: 2,
        spacing: 0.7,
        ..of_columns(
            s.reference,
            vec![
                ("displacement", Values::Vectors(vec![[0.0; 3]; count])),
                ("damage", Values::Scalars(vec![0.0; count])),
            ],
        )
    };
    let image = draw(&damaged(s, |x| x[0] > 7.5));
    let [whole, torn] = [0.0, 1.0].map(|d| number_of(&image, colormap::color(d)) as f64);
    // either half of the plate; a tenth of a cell overlaps at its rim
    assert!((torn / whole - 1.0).abs() < 0.05, "{torn} {whole}");
}

#[test]
fn a_point_that_flew_away_sets_neither_colours_nor_limits() {
    use super::extent::strays;
    use super::shown::Shown;
    let moved = |far: &dyn Fn(usize) -> f64| {
        let s = block([10, 10, 1], 2);
        let n = s.reference.len();
        let u = (0..n).map(|i| [far(i) + 0.01, 0.0, 0.0]).collect();
        let damage = (0..n).map(|i| f64::from(u8::from(far(i) != 0.0))).collect();
        with(
            with(s, "displacement", Values::Vectors(u)),
            "damage",
            Values::Scalars(damage),
        )
    };
    let count = |s: &Snapshot| strays(s).iter().filter(|x| **x).count();
    let end = |s: &Snapshot| Shown::of(s, "displacement", None).unwrap().range[1];
    // within a few spacings, and without bonds: of the body
    let near = moved(&|i| if i == 3 { 2.0 } else { 0.0 });
    assert_eq!((count(&near), end(&near)), (0, 2.01));
    let gone = moved(&|i| if i == 3 { 4.5 } else { 0.0 });
    assert_eq!(count(&gone), 1);
    assert!((end(&gone) - 0.01).abs() < 1e-12, "{}", end(&gone));
    // a body in pieces is what there is to see
    let crushed = moved(&|i| if i % 2 == 0 { 3.5 } else { 0.0 });
    assert_eq!((count(&crushed), end(&crushed)), (0, 3.51));
}

fn ball(radius: f64, center: [f64; 3]) -> Placed {
    Placed::new(rigid::Form::Ball(radius), center)
}

/// Rows and columns (fractions of a picture between head and foot) of pixels of steel: grey, and no part of a map.
fn steel(image: &Image) -> Vec<[f64; 2]> {
    let grey = |p: &Color| {
        let [r, g, b] = p.map(f64::from);
        (70.0..235.0).contains(&r)
            && (1.0..1.1).contains(&(g / r))
            && (1.03..1.2).contains(&(b / r))
    };
    let views = views(image);
    let all = (0..views.pixels.len()).filter(|i| grey(&views.pixels[*i]));
    all.map(|i| {
        let [row, column] = [i / views.width, i % views.width];
        [
            row as f64 / views.height as f64,
            column as f64 / views.width as f64,
        ]
    })
    .collect()
}

fn seen(s: &Snapshot, bodies: &[Placed]) -> Vec<[f64; 2]> {
    steel(&picture(s, bodies, &PictureOptions::default(), About::Fracture).unwrap())
}

#[test]
fn rigid_bodies_are_drawn_where_they_are_and_shaded() {
    let plate = block([40, 20, 1], 2);
    assert_eq!(seen(&plate, &[]).len(), 0);
    let middle =
        |all: &[[f64; 2]], k: usize| all.iter().map(|p| p[k]).sum::<f64>() / all.len() as f64;
    let [left, right] = [6.0, 33.0].map(|x| seen(&plate, &[ball(3.0, [x, 23.0, 0.0])]));
    assert!(
        left.len() > 2000 && right.len() > 2000,
        "{} {}",
        left.len(),
        right.len()
    );
    assert!(middle(&left, 1) < 0.3 && middle(&right, 1) > 0.7);
    // a block, turned by 45°, is as high as its diagonal
    let half = [4.0, 4.0, 1.0];
    let square = rigid::Form::of(&peridyne::space::rigid::RigidShape::Box { half }, 2);
    let c = 0.5f64.sqrt();
    let turned = Placed {
        axes: [[c, -c, 0.0], [c, c, 0.0], [0.0, 0.0, 1.0]],
        ..Placed::new(square.clone(), [20.0, 9.0, 0.0])
    };
    let width = |all: &[[f64; 2]]| {
        let ends = all
            .iter()
            .map(|p| p[1])
            .fold([1.0, 0.0], |[l, h]: [f64; 2], x| [l.min(x), h.max(x)]);
        ends[1] - ends[0]
    };
    let straight = seen(&plate, &[Placed::new(square, [20.0, 9.0, 0.0])]);
    let ratio = width(&seen(&plate, &[turned])) / width(&straight);
    assert!((ratio / 2f64.sqrt() - 1.0).abs() < 0.03, "{ratio}");
    // in space light falls from above left, and the cut shows the inside
    let solid = block([30, 30, 8], 3);
    let image = picture(
        &solid,
        &[ball(6.0, [14.5, 14.5, 14.0])],
        &PictureOptions::default(),
        About::Fracture,
    )
    .unwrap();
    let greys: std::collections::HashSet<Color> = image
        .pixels
        .iter()
        .copied()
        .filter(|p| p[0] < p[2] && p[2] - p[0] < 30 && p[0] > 80)
        .collect();
    assert!(greys.len() > 30, "{}", greys.len());
    // captions are below the views
    let there = |p: &&[f64; 2]| p[1] > 0.5 && p[0] < 0.85;
    assert!(steel(&image).iter().filter(there).count() > 500);
}

#[test]
fn a_solid_in_front_hides_and_one_behind_does_not_show() {
    let solid = block([30, 30, 8], 3);
    let drawn = |bodies: &[Placed]| {
        picture(&solid, bodies, &PictureOptions::default(), About::Fracture).unwrap()
    };
    // in the middle of what the cut leaves
    let inside = ball(2.0, [14.5, 22.0, 3.5]);
    assert_eq!(drawn(&[inside]), drawn(&[]));
    // its upper half stands out of the body, and the picture shows as much as before
    let out = drawn(&[ball(2.0, [14.5, 22.0, 7.0])]);
    let before = drawn(&[]);
    let changed = |i: &&usize| out.pixels.get(**i) != before.pixels.get(**i);
    let count = (0..before.pixels.len()).collect::<Vec<usize>>();
    assert!(count.iter().filter(changed).count() > 1000);
}

/// Frames of an animated PNG.
fn frames(path: &Path) -> Vec<Image> {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let count = reader.info().animation_control().unwrap().num_frames;
    let (width, height) = reader.info().size();
    (0..count)
        .map(|_| {
            let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut bytes).unwrap();
            let pixels = bytes.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
            Image {
                width: width as usize,
                height: height as usize,
                pixels,
            }
        })
        .collect()
}

#[test]
fn in_a_film_key_scale_and_camera_stand_still_and_bodies_move() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("film.png");
    let waiting = dir.path().join("film.frames");
    let mut film = film::Film::new(&waiting).unwrap();
    let options = PictureOptions {
        field: Some("energy_density".into()),
        ..PictureOptions::default()
    };
    let pass = |film: &mut film::Film, archive: &mut Archive<'_>| archive.part("film", film);
    // a plate grows and its values with it; a ball comes down beside it
    for n in 0..4u64 {
        let s = block([30, 12, 1], 2);
        let by = 0.1 * n as f64;
        let u = s.reference.iter().map(|x| [by * x[0], 0.0, 0.0]).collect();
        let values = s.reference.iter().map(|x| by * x[0]).collect();
        let s = with(
            with(s, "displacement", Values::Vectors(u)),
            "damage",
            Values::Scalars(values),
        );
        let mut s = Snapshot {
            step: n,
            time: n as f64,
            ..s
        };
        for column in &mut s.columns {
            if column.name() == "damage" {
                column.declaration.name = "energy_density".into();
            }
        }
        let bodies = [ball(2.0, [2.0, 20.0 - 2.0 * n as f64, 0.0])];
        film.push(&s, &bodies, &options).unwrap();
        if n != 1 {
            continue;
        }
        // the run is ended a frame later, and goes on from here
        let mut state = vec![];
        pass(&mut film, &mut Archive::save(&mut state));
        film.push(
            &Snapshot {
                step: 9,
                ..s.clone()
            },
            &[],
            &options,
        )
        .unwrap();
        film = film::Film::reopen(&waiting).unwrap();
        pass(&mut film, &mut Archive::load(&mut state.as_slice()));
        film.rewind(&s, &options).unwrap();
    }
    film.finish(
        &path,
        "energy_density",
        &options,
        1.0,
        (animate::FilmFormat::Png, None),
    )
    .unwrap();
    let all = frames(&path);
    assert_eq!(all.len(), 4);
    // the foot, with lengths and colours, is the same in all
    let foot = |i: &Image| i.pixels[(i.height - FOOT as usize) * i.width..].to_vec();
    assert!(all.iter().all(|i| foot(i) == foot(&all[0])));
    // a corner of the plate that nothing moves stays where it is, but for half the stretch of its cell; it has the lowest colour
    let dark = |i: &Image| {
        let first = i.pixels.iter().position(|p| *p == colormap::color(0.0));
        first.map(|n| [n % i.width, n / i.width])
    };
    let first = dark(&all[0]).unwrap();
    for [column, row] in all.iter().map(|i| dark(i).unwrap()) {
        assert_eq!(row, first[1]);
        assert!(column.abs_diff(first[0]) < 8, "{column} {first:?}");
    }
    let heights: Vec<f64> = { all.iter() }
        .map(|i| {
            let seen = steel(i);
            assert!(seen.len() > 300);
            seen.iter().map(|p| p[0]).sum::<f64>() / seen.len() as f64
        })
        .collect();
    assert!(
        heights.windows(2).all(|w| w[1] > w[0] + 0.02),
        "{heights:?}"
    );
}

#[test]
fn a_stretched_plate_shows_no_gaps() {
    let s = block([30, 10, 1], 2);
    let u = s
        .reference
        .iter()
        .map(|x| [1.2 * x[0], 0.1 * x[0], 0.0])
        .collect();
    let s = with(s, "displacement", Values::Vectors(u));
    let image = views(&draw(&s));
    // white pixels between two of the body in its middle rows
    for row in [0.45, 0.5, 0.55].map(|p| (p * image.height as f64) as usize) {
        let row = &image.pixels[row * image.width..][..image.width];
        let body: Vec<usize> = (0..row.len()).filter(|c| row[*c] != WHITE).collect();
        assert_eq!(body[body.len() - 1] - body[0] + 1, body.len());
    }
}

/// What a GIF shows, frame after frame, as RGB.
fn shown_by_gif(bytes: &[u8]) -> Vec<Vec<[u8; 3]>> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(bytes).unwrap();
    let mut all = vec![];
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!((frame.delay, frame.left, frame.top), (8, 0, 0));
        let pixels = frame.buffer.chunks_exact(4).map(|p| [p[0], p[1], p[2]]);
        all.push(pixels.collect());
    }
    all
}

#[test]
fn a_gif_of_few_colours_is_exact_and_one_of_many_is_near() {
    let image = |frame: usize, colours: usize| {
        let pixel = |n: usize| {
            let c = (n * 7 + frame) % colours;
            [(c % 251) as u8, (c / 251 * 40) as u8, (255 - c % 200) as u8]
        };
        Image {
            width: 200,
            height: 150,
            pixels: (0..30_000).map(pixel).collect(),
        }
    };
    for (colours, most) in [(200, 0.0), (1100, 6.0)] {
        let frames: Vec<Image> = (0..5).map(|n| image(n, colours)).collect();
        let mut bytes = vec![];
        let all = frames.iter().cloned().map(Ok);
        animate::animate(&mut bytes, animate::FilmFormat::Gif, 5, all).unwrap();
        let shown = shown_by_gif(&bytes);
        assert_eq!(shown.len(), 5);
        for (frame, shown) in frames.iter().zip(&shown) {
            let each = { frame.pixels.iter().zip(shown) }
                .flat_map(|(a, b)| (0..3).map(|c| f64::from(a[c].abs_diff(b[c]))));
            let mean = each.sum::<f64>() / (3.0 * frame.pixels.len() as f64);
            assert!(mean <= most, "{colours}: {mean}");
        }
    }
    let none = animate::animate(vec![], animate::FilmFormat::Gif, 0, std::iter::empty());
    assert!(none.is_err());
}
