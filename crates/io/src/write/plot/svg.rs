//! A drawing as SVG; text is text, in DejaVu Sans where the reader has it.

use std::fmt::Write;
use std::io;

use super::super::picture::image::{Align, Color};
use super::canvas::{Drawing, Outline, Shape};

pub fn draw(drawing: &Drawing) -> io::Result<String> {
    let (width, height) = (drawing.width, drawing.height);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"DejaVu Sans, Verdana, Arial, sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
    );
    for shape in &drawing.shapes {
        add(&mut out, shape)?;
    }
    out += "</svg>\n";
    Ok(out)
}

fn add(out: &mut String, shape: &Shape) -> io::Result<()> {
    // writing to a String does not fail
    let written = match shape {
        Shape::Path {
            points,
            width,
            color,
            dash,
        } => {
            let dash = dash.map_or(String::new(), |[ink, gap]| {
                format!(" stroke-dasharray=\"{ink} {gap}\"")
            });
            writeln!(
                out,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"{dash}/>",
                joined(points),
                hex(*color)
            )
        }
        Shape::Rectangle { corner, size, fill } => writeln!(
            out,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{}\"/>",
            corner[0],
            corner[1],
            size[0],
            size[1],
            hex(*fill)
        ),
        Shape::Marker {
            at,
            radius,
            outline: Outline::Disc,
            color,
        } => writeln!(
            out,
            "<circle cx=\"{:.2}\" cy=\"{:.2}\" r=\"{radius}\" fill=\"{}\"/>",
            at[0],
            at[1],
            hex(*color)
        ),
        Shape::Marker {
            at,
            radius,
            outline,
            color,
        } => writeln!(
            out,
            "<polygon points=\"{}\" fill=\"{}\"/>",
            joined(&outline.corners(*at, *radius)),
            hex(*color)
        ),
        Shape::Text {
            at: [x, y],
            text,
            size,
            align,
            upright,
            color,
        } => {
            let anchor = match align {
                Align::Left => "start",
                Align::Center => "middle",
                Align::Right => "end",
            };
            let turn = if *upright {
                format!(" transform=\"rotate(-90 {x:.2} {y:.2})\"")
            } else {
                String::new()
            };
            writeln!(
                out,
                "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{}\"{turn}>{}</text>",
                hex(*color),
                escaped(text)
            )
        }
        Shape::Pixels {
            corner,
            size,
            image,
        } => {
            let mut png = Vec::new();
            image.write_png(&mut png)?;
            writeln!(
                out,
                "<image x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
                corner[0],
                corner[1],
                size[0],
                size[1],
                base64(&png)
            )
        }
    };
    written.map_err(io::Error::other)
}

fn joined(points: &[[f64; 2]]) -> String {
    let pairs: Vec<String> = points
        .iter()
        .map(|[x, y]| format!("{x:.2},{y:.2}"))
        .collect();
    pairs.join(" ")
}

fn hex([r, g, b]: Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

/// RFC 4648.
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let at = |k: usize| u32::from(*chunk.get(k).unwrap_or(&0));
        let word = at(0) << 16 | at(1) << 8 | at(2);
        for k in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * k)) as usize & 63];
            text.push(if k <= chunk.len() {
                char::from(digit)
            } else {
                '='
            });
        }
    }
    text
}
