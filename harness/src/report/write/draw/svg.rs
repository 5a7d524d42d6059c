//! Makes the text of plotters' SVG backend compact: it writes every stroke as an element with all its attributes and absolute
//! coordinates, and dashed curves have hundreds of strokes.

use std::fmt::Write;

/// Lines and areas become paths in relative coordinates, neighbours with the same looks one path; defaults are left out or moved
/// to the root; the size is given in pixels of the page while the coordinates stay fine.
pub(super) fn compact(svg: &str, [width, height]: [u32; 2]) -> String {
    let mut out = String::with_capacity(svg.len() / 4);
    let mut open: Option<Path<'_>> = None;
    for line in svg.lines() {
        if let Some(path) = Path::read(line) {
            match &mut open {
                Some(same) if same.looks == path.looks && same.closed == path.closed => {
                    same.data.push_str(&path.data);
                }
                _ => {
                    if let Some(done) = open.replace(path) {
                        done.write(&mut out);
                    }
                }
            }
            continue;
        }
        if let Some(done) = open.take() {
            done.write(&mut out);
        }
        if line.starts_with("<svg ") {
            let view = line.find("viewBox").map_or(">", |at| &line[at..]);
            let defaults = "font-family=\"sans-serif\" stroke-linejoin=\"round\"";
            out.push_str(&format!("<svg width=\"{width}\" height=\"{height}\" {defaults} {view}"));
        } else {
            out.push_str(&without_defaults(line));
        }
        out.push('\n');
    }
    if let Some(done) = open {
        done.write(&mut out);
    }
    out
}

/// Lines or areas of the same looks.
struct Path<'a> {
    looks: &'a str,
    closed: bool,
    data: String,
}

impl<'a> Path<'a> {
    fn read(line: &'a str) -> Option<Self> {
        let (rest, closed) = match line.strip_prefix("<polyline ") {
            Some(rest) => (rest, false),
            None => (line.strip_prefix("<polygon ")?, true),
        };
        let (looks, points) = rest.split_once(" points=\"")?;
        let mut data = relative(points.strip_suffix("\"/>")?)?;
        if closed {
            data.push('z');
        }
        Some(Self { looks, closed, data })
    }

    fn write(&self, out: &mut String) {
        out.push_str(&format!("<path {} d=\"{}\"/>\n", without_defaults(self.looks), self.data));
    }
}

fn without_defaults(attributes: &str) -> String {
    attributes
        .replace("opacity=\"1\" ", "")
        .replace(" opacity=\"1\"", "")
        .replace(" font-family=\"sans-serif\"", "")
}

/// Path data of "x,y x,y …": the first point is absolute, the others are steps.
fn relative(points: &str) -> Option<String> {
    let mut data = String::new();
    let mut last: Option<(i32, i32)> = None;
    for point in points.split_ascii_whitespace() {
        let (x, y) = point.split_once(',')?;
        let (x, y): (i32, i32) = (x.parse().ok()?, y.parse().ok()?);
        let (command, dx, dy) = match last {
            None => ("M", x, y),
            // The letter is needed once; a minus sign separates as well as a space.
            Some((x0, y0)) if data.contains('l') => (if x < x0 { "" } else { " " }, x - x0, y - y0),
            Some((x0, y0)) => ("l", x - x0, y - y0),
        };
        let gap = if dy < 0 { "" } else { " " };
        write!(data, "{command}{dx}{gap}{dy}").ok()?;
        last = Some((x, y));
    }
    last.map(|_| data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_neighbours_become_one_path() {
        let svg = "<svg width=\"20\" height=\"20\" viewBox=\"0 0 20 20\" xmlns=\"x\">\n\
                   <polyline fill=\"none\" opacity=\"1\" stroke=\"#000000\" stroke-width=\"3\" points=\"0,0 1,1 3,0 2,0 \"/>\n\
                   <polyline fill=\"none\" opacity=\"1\" stroke=\"#000000\" stroke-width=\"3\" points=\"2,2 3,3 \"/>\n\
                   <polygon opacity=\"1\" fill=\"#FFFFFF\" points=\"0,0 1,1 0,1 \"/>\n\
                   </svg>\n";
        assert_eq!(
            compact(svg, [10, 10]),
            "<svg width=\"10\" height=\"10\" font-family=\"sans-serif\" stroke-linejoin=\"round\" viewBox=\"0 0 20 20\" \
             xmlns=\"x\">\n\
             <path fill=\"none\" stroke=\"#000000\" stroke-width=\"3\" d=\"M0 0l1 1 2-1-1 0M2 2l1 1\"/>\n\
             <path fill=\"#FFFFFF\" d=\"M0 0l1 1-1 0z\"/>\n\
             </svg>\n"
        );
    }
}
