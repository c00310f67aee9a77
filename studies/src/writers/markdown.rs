//! Markdown as HTML for pages: no raw HTML passes, and images are what the page itself can draw.

use crate::figures::format::escape;
use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};

/// Places of images in a text, in order.
pub fn images(text: &str) -> Vec<String> {
    let image = |event: Event| match event {
        Event::Start(Tag::Image { dest_url, .. }) => Some(dest_url.to_string()),
        _ => None,
    };
    Parser::new_ext(text, options()).filter_map(image).collect()
}

fn options() -> Options {
    Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES | Options::ENABLE_SUPERSCRIPT | Options::ENABLE_SUBSCRIPT
}

/// A text as HTML. `draw` gives what stands at the place of an image; where there is nothing, the place is named.
pub fn markdown(text: &str, draw: &dyn Fn(&str) -> Option<String>) -> String {
    let mut events: Vec<Event> = Vec::new();
    // Place and words of the image that is being read.
    let mut image: Option<(String, String)> = None;
    for event in Parser::new_ext(text, options()) {
        match (event, &mut image) {
            (Event::Start(Tag::Image { dest_url, .. }), _) => image = Some((dest_url.to_string(), String::new())),
            (Event::End(TagEnd::Image), Some((place, words))) => {
                let drawn = draw(place).unwrap_or_else(|| format!("<p class=\"bad\">no {}</p>", escape(place)));
                let html = format!("<figure>{drawn}<figcaption>{}</figcaption></figure>", escape(words));
                events.push(Event::InlineHtml(html.into()));
                image = None;
            }
            (Event::Text(more) | Event::Code(more), Some((_, words))) => *words += &more,
            (Event::SoftBreak | Event::HardBreak, Some((_, words))) => words.push(' '),
            (_, Some(_)) => {}
            (Event::Html(raw) | Event::InlineHtml(raw), None) => {
                events.push(Event::Text(CowStr::from(raw.to_string())))
            }
            (event, None) => events.push(event),
        }
    }
    let mut out = String::new();
    html::push_html(&mut out, events.into_iter());
    // A figure stands by itself, not in a paragraph.
    out.replace("<p><figure>", "<figure>").replace("</figure></p>", "</figure>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_drawn_and_raw_html_is_text() {
        let draw = |place: &str| (place == "chart:a").then(|| "<svg/>".to_string());
        let html =
            markdown("Text *now*\n\n![words **here**](chart:a)\n\n<script>alert(1)</script>\n\n![x](chart:b)", &draw);
        assert!(html.contains("<em>now</em>"), "{html}");
        assert!(html.contains("<figure><svg/><figcaption>words here</figcaption></figure>"), "{html}");
        assert!(!html.contains("<script") && html.contains("&lt;script"), "{html}");
        assert!(html.contains("no chart:b"), "{html}");
        assert_eq!(images("a ![b](c:d) e ![f](g)"), ["c:d", "g"]);
    }
}
