//! The figures of `figures` as PNG, for programs that cannot read SVG. Compiled only with the feature `png`.

use super::figures::Figures;
use super::register::register;
use super::writer::Writer;
use crate::output::StudyOutput;
use rayon::prelude::*;
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};
use serde_json::Value as Json;
use std::sync::Arc;
use voussoir_core::plugin::Keys;
use voussoir_study::config::common_keys::own_keys;

/// The background of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum Background {
    /// White.
    White,
    /// Transparent.
    Transparent,
}

/// `[output.options.png]`.
#[derive(Debug, Clone, Keys)]
pub struct PngOptions {
    /// width of each figure in pixels
    #[key(range = ">= 16, <= 20_000", default = 1600)]
    width: u32,
    /// what lies behind the figure
    #[key(default = "white")]
    background: Background,
}

/// Writes `figures/*.png`.
#[derive(Debug)]
pub struct Png;

impl Writer for Png {
    fn files(&self, study: &StudyOutput, options: &Json) -> Vec<(String, Vec<u8>)> {
        // Only if the study lists this writer, because figures are always available as SVG.
        if !study.output.writers.iter().flatten().any(|tag| tag == "png") {
            return Vec::new();
        }
        let PngOptions { width, background } = own_keys(options).unwrap_or_else(PngOptions::defaults);
        let background = (background == Background::White).then_some(Color::WHITE);
        let reading = reading();
        let pixels = |(name, svg): (String, Vec<u8>)| {
            let bytes = png(&svg, width, background, &reading)?;
            Some((name.replace(".svg", ".png"), bytes))
        };
        Figures.files(study, &Json::Null).into_par_iter().filter_map(pixels).collect()
    }
}

/// The only font is part of the program, so that a figure is the same on every machine.
fn reading() -> Options<'static> {
    let mut fonts = Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.load_font_data(dejavu::sans::bold().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    Options { font_family: "DejaVu Sans".into(), fontdb: Arc::new(fonts), ..Options::default() }
}

/// Rasterises an SVG to `width` pixels. Returns `None` if the text is not valid SVG.
fn png(svg: &[u8], width: u32, background: Option<Color>, reading: &Options) -> Option<Vec<u8>> {
    let tree = Tree::from_data(svg, reading).ok()?;
    let scale = width as f32 / tree.size().width();
    let height = (tree.size().height() * scale).ceil().max(1.0) as u32;
    let mut pixels = Pixmap::new(width, height)?;
    if let Some(colour) = background {
        pixels.fill(colour);
    }
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().ok()
}

register!(
    "png",
    Png,
    "figures/*.png: the figures as pixels, where it is asked for by name",
    PngOptions,
    "# `png`\n\nWrites every figure of `figures` as `figures/*.png`, with text in DejaVu Sans, which is part of the program: the same \
     pixels on every machine. It writes only where it is named:\n\n```toml\n[output]\nwriters = [\"figures\", \"png\"]\n\
     [output.options.png]\nwidth = 2400\nbackground = \"transparent\"\n```\n\nIt is there in a program that is compiled with \
     `cargo build --release -p voussoir --features png`.\n"
);

#[cfg(test)]
mod tests {
    use super::*;

    const FIGURE: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 20' width='40' height='20'>\
        <rect x='0' y='0' width='20' height='20' fill='#f00'/>\
        <text x='22' y='15' font-family='Helvetica, sans-serif' font-size='14'>W</text></svg>";

    /// Checks the size of the picture, the pixels of a shape and of a text, and the background.
    #[test]
    fn a_figure_becomes_the_pixels_it_says() {
        let draw = |background| {
            let bytes = png(FIGURE.as_bytes(), 80, background, &reading()).expect("a figure");
            Pixmap::decode_png(&bytes).expect("a picture")
        };
        let (white, clear) = (draw(Some(Color::WHITE)), draw(None));
        assert_eq!((white.width(), white.height()), (80, 40));
        let at = |pixels: &Pixmap, x, y| pixels.pixel(x, y).map(|p| [p.red(), p.green(), p.blue(), p.alpha()]);
        assert_eq!(at(&white, 10, 10), Some([255, 0, 0, 255]));
        assert_eq!(at(&white, 78, 38), Some([255; 4]));
        assert_eq!(at(&clear, 78, 38), Some([0; 4]));
        let ink = (44..80)
            .flat_map(|x| (8..32).map(move |y| (x, y)))
            .filter(|&(x, y)| white.pixel(x, y).is_some_and(|p| p.red() < 64));
        assert!(ink.count() > 40, "text is missing");
        assert!(png(b"no figure", 80, None, &reading()).is_none());
    }
}
