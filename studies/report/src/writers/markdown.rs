//! Converts Markdown to HTML for pages. Raw HTML is removed, only few kinds of links are allowed, and the page draws
//! every image itself.

use super::links::is_allowed;
use super::page::figure;
use maud::{Markup, PreEscaped, html};
use pulldown_cmark::{Alignment, CowStr, Event, LinkType, Options, Parser, Tag, TagEnd, html as events};

/// Addresses of the images in a text, in order.
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

/// Converts a text to HTML. `draw` returns the drawing for the address of an image; without a drawing the address is
/// shown. A link that is not allowed is replaced by its text and address.
pub fn markdown(text: &str, draw: &dyn Fn(&str) -> Option<String>) -> Markup {
    let mut page = Page { draw, events: Vec::new(), image: None, links: Vec::new(), table: Table::default() };
    Parser::new_ext(text, options()).for_each(|event| page.add(event));
    let mut out = String::new();
    events::push_html(&mut out, page.events.into_iter());
    // A figure must not be inside a paragraph.
    PreEscaped(out.replace("<p><figure>", "<figure>").replace("</figure></p>", "</figure>"))
}

/// Converts the events of the parser.
struct Page<'a> {
    draw: &'a dyn Fn(&str) -> Option<String>,
    events: Vec<Event<'a>>,
    /// Address and text of the image that is being read.
    image: Option<(String, String)>,
    /// The address of each open link that is not allowed; `None` for an allowed link.
    links: Vec<Option<String>>,
    table: Table,
}

/// The table that is being read. Cells are aligned by classes, because the page's policy allows no style attributes.
#[derive(Default)]
struct Table {
    alignments: Vec<Alignment>,
    head: bool,
    column: usize,
}

impl<'a> Page<'a> {
    fn add(&mut self, event: Event<'a>) {
        match (event, &mut self.image) {
            (Event::Start(Tag::Image { dest_url, .. }), _) => self.image = Some((dest_url.to_string(), String::new())),
            (Event::End(TagEnd::Image), Some((place, words))) => {
                let figure = match (self.draw)(place) {
                    Some(drawn) => figure(&drawn, words),
                    None => html! { figure { p class="bad" { "no " (place) } figcaption { (words) } } },
                };
                self.raw(figure);
                self.image = None;
            }
            (Event::Text(more) | Event::Code(more), Some((_, words))) => *words += &more,
            (Event::SoftBreak | Event::HardBreak, Some((_, words))) => words.push(' '),
            (_, Some(_)) => {}
            (Event::Html(raw) | Event::InlineHtml(raw), None) => {
                self.events.push(Event::Text(CowStr::from(raw.to_string())));
            }
            (Event::Start(tag), None) => self.start(tag),
            (Event::End(tag), None) => self.end(tag),
            (event, None) => self.events.push(event),
        }
    }

    fn raw(&mut self, markup: Markup) {
        self.events.push(Event::InlineHtml(markup.into_string().into()));
    }

    fn start(&mut self, tag: Tag<'a>) {
        match tag {
            Tag::Link { link_type, dest_url, title, id } => {
                // For a plain e-mail address, the scheme is added when it is written.
                let allowed = link_type == LinkType::Email || is_allowed(&dest_url);
                self.links.push((!allowed).then(|| dest_url.to_string()));
                if allowed {
                    self.events.push(Event::Start(Tag::Link { link_type, dest_url, title, id }));
                }
            }
            Tag::Table(alignments) => {
                self.table.alignments = alignments;
                self.events.push(Event::Start(Tag::Table(Vec::new())));
            }
            Tag::TableHead | Tag::TableRow => {
                (self.table.head, self.table.column) = (tag == Tag::TableHead, 0);
                self.events.push(Event::Start(tag));
            }
            Tag::TableCell => {
                let class = match self.table.alignments.get(self.table.column) {
                    Some(Alignment::Center) => " class=\"center\"",
                    Some(Alignment::Right) => " class=\"right\"",
                    _ => "",
                };
                self.raw(PreEscaped(format!("<t{}{class}>", if self.table.head { 'h' } else { 'd' })));
                self.table.column += 1;
            }
            tag => self.events.push(Event::Start(tag)),
        }
    }

    fn end(&mut self, tag: TagEnd) {
        if tag == TagEnd::Link
            && let Some(Some(address)) = self.links.pop()
        {
            self.raw(html! { " " span class="bad" { "(this link is not allowed: " (address) ")" } });
            return;
        }
        self.events.push(Event::End(tag));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_drawn_and_raw_html_is_text() {
        let draw = |place: &str| (place == "chart:a").then(|| "<svg/>".to_string());
        let html =
            markdown("Text *now*\n\n![words **here**](chart:a)\n\n<script>alert(1)</script>\n\n![x](chart:b)", &draw)
                .into_string();
        assert!(html.contains("<em>now</em>"), "{html}");
        assert!(html.contains("<figure><svg/><figcaption>words here</figcaption></figure>"), "{html}");
        assert!(!html.contains("<script") && html.contains("&lt;script"), "{html}");
        assert!(html.contains("no chart:b"), "{html}");
        assert_eq!(images("a ![b](c:d) e ![f](g)"), ["c:d", "g"]);
    }

    /// All spellings of Markdown by which a script could enter an address, an element or an attribute.
    #[test]
    fn no_spelling_makes_a_script() {
        let hostile = [
            "[a](javascript:alert(1))",
            "[a](<javascript:alert(1)>)",
            "[a](jAvAsCrIpT:alert(1) \"title\")",
            "[a](&#106;avascript:alert(1))",
            "[a](&#x6A;avascript&colon;alert(1))",
            "[a](java\\script:alert(1))",
            "[a](javascript\\:alert(1))",
            "[a](java&Tab;script:alert(1))",
            "[a](java&NewLine;script:alert(1))",
            "[a](&#1;javascript:alert(1))",
            "[a](<\tjavascript:alert(1)>)",
            "[a](data:text/html,<script>alert(1)</script>)",
            "[a](vbscript:msgbox(1))",
            "[a](//example.org/)",
            "[a](\\\\\\\\example.org)",
            "[a](/\\\\example.org)",
            "[a][b]\n\n[b]: javascript:alert(1)",
            "[b]\n\n[b]: <data:text/html,x> 'title'",
            "[b][]\n\n[b]:\n  javascript:alert(1)",
            "<javascript:alert(1)>",
            "<data:text/html,x>",
            "![a](javascript:alert(1))",
            "![a][b]\n\n[b]: javascript:alert(1)",
            "[![a](chart:x)](javascript:alert(1))",
            "[a *b* `c`](javascript:alert(1)) [d](vbscript:x)",
            "[a](x\" onclick=\"alert(1)\")",
            "[a](https://example.org/\"onmouseover=alert(1))",
            "[a](https://example.org '\"><img src=x onerror=alert(1)>')",
            "<a href=\"javascript:alert(1)\">a</a>",
            "<img src=x onerror=alert(1)>",
            "<svg onload=alert(1)>\n\n<style>*{}</style>\n\n<base href=//example.org>",
            "a[^1]\n\n[^1]: [b](javascript:alert(1))",
            "| [a](javascript:alert(1)) |\n|--:|\n| <b style='x'> |",
            "# [a](javascript:alert(1))",
            "- [a](javascript:alert(1))",
            "```\\\"onclick=alert(1)\na\n```",
        ];
        for text in hostile {
            let html = markdown(text, &|_| None).into_string();
            for tag in html.split('<').skip(1).map(|rest| &rest[..rest.find('>').expect("an end")]) {
                let (name, attributes) = tag.split_once(' ').unwrap_or((tag, ""));
                assert!(!["script", "style", "base", "img", "svg", "b", "iframe"].contains(&name), "{text}: {html}");
                // The attributes without their quoted values.
                let bare: String = attributes.split('"').step_by(2).collect();
                assert!(!bare.contains("on") && !bare.contains("style") && !bare.contains("src"), "{text}: {html}");
                if let Some((_, address)) = attributes.split_once("href=\"") {
                    let address = address.split('"').next().expect("an address");
                    assert!(
                        address.starts_with('#') || address.starts_with("https://example.org") || address == "x%22",
                        "{text}: {html}"
                    );
                }
            }
        }
    }

    #[test]
    fn allowed_links_stay_and_others_are_named() {
        let html =
            markdown("[a](https://example.org) <mail@example.org> [b](#c) [*d*](javascript:x) <http://e>", &|_| None)
                .into_string();
        for link in ["https://example.org\">a", "mailto:mail@example.org\">mail", "#c\">b", "http://e\">http"] {
            assert!(html.contains(&format!("<a href=\"{link}")), "{html}");
        }
        assert!(
            html.contains("<em>d</em> <span class=\"bad\">(this link is not allowed: javascript:x)</span>"),
            "{html}"
        );
        assert_eq!(html.matches("</a>").count(), 4, "{html}");
    }

    #[test]
    fn cells_are_aligned_by_classes() {
        let html = markdown("| a | b | c |\n|:--|--:|:-:|\n| d | e | f |", &|_| None).into_string();
        let head = "<th>a</th><th class=\"right\">b</th><th class=\"center\">c</th>";
        assert!(
            html.contains(head)
                && html.contains(&head.replace("th", "td").replace("a<", "d<").replace("b<", "e<").replace("c<", "f<")),
            "{html}"
        );
    }
}
