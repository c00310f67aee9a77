//! Several charts in one drawing, in rows of two.

use crate::svg::{WIDTH, escape, own_ids};

/// Width and height of a chart \[px\].
fn size(svg: &str) -> [f64; 2] {
    let of = |name: &str| svg.split(&format!(" {name}=\"")).nth(1)?.split('"').next()?.parse().ok();
    ["width", "height"].map(|name| of(name).unwrap_or(0.0))
}

/// Puts charts side by side, two in each row. A single chart stays as it is.
pub fn panels(charts: &[String]) -> String {
    if let [chart] = charts {
        return chart.clone();
    }
    let sizes: Vec<[f64; 2]> = charts.iter().map(|chart| size(chart)).collect();
    let (mut y, mut body) = (0.0, String::new());
    for (row, pair) in charts.chunks(2).enumerate() {
        for (column, chart) in pair.iter().enumerate() {
            let placed = format!("<svg x=\"{:.0}\" y=\"{y:.0}\"", column as f64 * WIDTH);
            body += &own_ids(&chart.replacen("<svg", &placed, 1), &format!("panel-{row}-{column}"));
        }
        y += sizes[2 * row..(2 * row + 2).min(sizes.len())].iter().map(|size| size[1]).fold(0.0, f64::max);
    }
    let name = escape(&format!("{} charts", charts.len()));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{y:.0}\" viewBox=\"0 0 {w:.0} {y:.0}\" role=\"img\">\n\
         <title>{name}</title>\n{body}</svg>\n",
        w = 2.0 * WIDTH
    )
}

#[cfg(test)]
mod tests {
    use super::{panels, size};
    use crate::chart::chart_svg;
    use crate::series::Series;

    /// Three charts take two rows; every chart keeps its size.
    #[test]
    fn charts_stand_in_rows_of_two() {
        let series = [Series { name: "a".into(), points: vec![(0.0, 1.0), (1.0, 2.0)], ..Series::default() }];
        let chart = chart_svg("one", "x", "y", &series, &[]);
        let [width, height] = size(&chart);
        assert_eq!(panels(std::slice::from_ref(&chart)), chart);
        let all = panels(&[chart.clone(), chart.clone(), chart]);
        assert_eq!(size(&all), [2.0 * width, 2.0 * height]);
        assert_eq!(all.matches("<svg").count(), 4);
    }
}
