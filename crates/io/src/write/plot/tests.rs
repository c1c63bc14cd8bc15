use super::canvas::Shape;
use super::*;

fn wave() -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let x: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.0157).collect();
    let a = x.iter().map(|k| 2.0 * (0.5 * k).sin()).collect();
    let b = x.iter().map(|k| (1.3 * k).tanh()).collect();
    (x, a, b)
}

fn decoded(path: &std::path::Path) -> (u32, u32, Vec<u8>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    (info.width, info.height, bytes)
}

/// Pixels of a colour.
fn count(bytes: &[u8], color: [u8; 3]) -> usize {
    bytes.chunks_exact(3).filter(|p| **p == color).count()
}

#[test]
fn lines_are_in_both_files() {
    let (x, a, b) = wave();
    let few: Vec<f64> = x.iter().step_by(40).copied().collect();
    let dots: Vec<f64> = b.iter().step_by(40).copied().collect();
    let plot = Plot::new("Dispersion")
        .x("k δ", "")
        .y("ω", "1/s")
        .line("MD, N = 20", &x, &a)
        .dashed("PD <coarse> & fine", &x, &b)
        .points("measured", &few, &dots);
    let dir = tempfile::tempdir().unwrap();
    let [png, svg] = plot.save(&dir.path().join("new"), "p").unwrap();
    let (w, h, bytes) = decoded(&png);
    assert_eq!((w, h), (1520, 960));
    // a line of 3.6 pixels over 1300 columns; dashes have 8 of 13
    let (blue, red) = (count(&bytes, [0, 114, 178]), count(&bytes, [213, 94, 0]));
    assert!(blue > 3000 && red > 1500 && red < blue, "{blue} {red}");
    let text = std::fs::read_to_string(svg).unwrap();
    assert!(text.contains("PD &lt;coarse&gt; &amp; fine") && text.contains("ω (1/s)"));
    assert_eq!(text.matches("stroke-dasharray").count(), 2);
    assert_eq!(text.matches("<circle").count(), 11);
}

#[test]
fn lines_end_at_the_frame_and_at_gaps() {
    let x = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
    let y = [0.0, 10.0, 0.0, f64::NAN, 0.5, 0.5];
    let plot = Plot::new("").line("", &x, &y).y_range(0.0, 1.0);
    let drawing = plot.draw().unwrap();
    let paths: Vec<&Vec<[f64; 2]>> = drawing
        .shapes
        .iter()
        .filter_map(|s| match s {
            Shape::Path { points, color, .. } if *color == [0, 114, 178] => Some(points),
            _ => None,
        })
        .collect();
    // up to the edge, down from the edge, and behind the gap
    assert_eq!(paths.len(), 3);
    assert_eq!(paths[0][1][1], paths[1][0][1]);
    assert!(paths[2][0][1] > paths[0][1][1]);
}

#[test]
fn rows_of_a_map_lie_where_they_should() {
    let map = |down: bool| {
        let map = Map::new("density")
            .x("x", "m", [0.0, 4.0])
            .y("t", "s", [0.0, 2.0])
            .grid(2, &[0.0, 0.0, 1.0, f64::NAN]);
        let map = if down { map.y_down() } else { map };
        let drawing = map.value("ρ", "").draw().unwrap();
        let image = drawing.shapes.iter().find_map(|s| match s {
            Shape::Pixels { image, .. } => Some(image.clone()),
            _ => None,
        });
        image.unwrap().pixels
    };
    let (low, high) = (
        ColorMap::Sequential.color(0.0),
        ColorMap::Sequential.color(1.0),
    );
    let missing = ColorMap::Sequential.color(f64::NAN);
    assert_eq!(map(true), [low, low, high, missing]);
    assert_eq!(map(false), [high, missing, low, low]);
}

#[test]
fn many_values_become_means() {
    let values: Vec<f64> = (0..40_000).map(|k| f64::from(k % 2)).collect();
    let map = Map::new("")
        .grid(20_000, &values)
        .between(0.0, 1.0)
        .colors(ColorMap::Diverging);
    let drawing = map.draw().unwrap();
    let Some(Shape::Pixels { image, .. }) = drawing
        .shapes
        .iter()
        .find(|s| matches!(s, Shape::Pixels { .. }))
    else {
        panic!("no pixels")
    };
    assert!(image.width < 1600 && image.height == 2);
    let grey = image
        .pixels
        .iter()
        .filter(|p| p.iter().all(|c| *c > 215))
        .count();
    assert_eq!(grey, image.pixels.len());
}

#[test]
fn maps_are_in_both_files() {
    let values: Vec<f64> = (0..100 * 60)
        .map(|k| (0.1 * f64::from(k % 100)).sin() * f64::from(k / 100))
        .collect();
    let map = Map::new("field")
        .x("x", "m", [0.0, 1.0])
        .y("t", "s", [0.0, 3.0])
        .value("density", "kg/m³")
        .grid(100, &values)
        .y_down();
    let dir = tempfile::tempdir().unwrap();
    let [png, svg] = map.save(dir.path(), "m").unwrap();
    assert_eq!(decoded(&png).0, 1520);
    let text = std::fs::read_to_string(svg).unwrap();
    assert_eq!(text.matches("data:image/png;base64,iVBORw0KGgo").count(), 2);
    let points = [[0.25, 0.25], [0.75, 0.75]];
    let map = Map::new("")
        .points(&points, &[0.0, 1.0], 0.5)
        .equal()
        .colors(ColorMap::Diverging);
    let [png, _] = map.save(dir.path(), "s").unwrap();
    let (w, h, bytes) = decoded(&png);
    // each square is a quarter of the field, which is about two thirds of the page
    let red = count(&bytes, [178, 24, 43]);
    assert!(red > (w * h / 10) as usize, "{red} of {w} x {h}");
}

#[test]
fn what_cannot_be_plotted_is_said() {
    let dir = tempfile::tempdir().unwrap();
    let told = |e: WriteError, message: &str| {
        let text = e.to_string();
        assert!(text.contains("p.png") && text.contains(message), "{text}");
    };
    told(
        Plot::new("")
            .line("a", &[1.0], &[])
            .save(dir.path(), "p")
            .unwrap_err(),
        "`a` has 1 values of x and 0 of y",
    );
    told(
        Plot::new("")
            .line("a", &[1.0], &[f64::NAN])
            .save(dir.path(), "p")
            .unwrap_err(),
        "no finite value",
    );
    told(
        Plot::new("")
            .log_y()
            .line("a", &[1.0], &[-1.0])
            .save(dir.path(), "p")
            .unwrap_err(),
        "no positive finite value",
    );
    told(
        Map::new("")
            .grid(3, &[1.0; 4])
            .save(dir.path(), "p")
            .unwrap_err(),
        "4 values do not fill rows of 3",
    );
    told(Map::new("").save(dir.path(), "p").unwrap_err(), "no data");
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn base64_is_that_of_the_standard() {
    for (text, coded) in [
        ("", ""),
        ("f", "Zg=="),
        ("fo", "Zm8="),
        ("foo", "Zm9v"),
        ("foobar", "Zm9vYmFy"),
    ] {
        assert_eq!(svg::base64(text.as_bytes()), coded);
    }
}
