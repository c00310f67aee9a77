//! The links that a page may contain: http, https, mailto, a place on the page, and files beside it.

/// Schemes that open a page or a message and never run a script in the report.
const SCHEMES: [&str; 3] = ["http", "https", "mailto"];

/// Returns true if a page may link to this address.
///
/// A relative link must stay on the reader's machine: it contains no backslash and no `//`, because browsers read
/// `//host`, `\\host` and some longer spellings as another host. A control character hides a scheme from this
/// check (browsers drop tabs and line breaks), so an address with one is refused.
pub(crate) fn is_allowed(address: &str) -> bool {
    if address.chars().any(char::is_control) || address != address.trim() {
        return false;
    }
    let path = address.split(['?', '#']).next().unwrap_or_default();
    match path.split_once(':') {
        Some((scheme, _)) => SCHEMES.iter().any(|known| scheme.eq_ignore_ascii_case(known)),
        None => !path.contains("//") && !path.contains('\\'),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Only the three schemes and relative addresses are allowed, whatever the spelling.
    #[test]
    fn a_script_is_never_an_address() {
        let allowed = "https://example.org http://example.org/a?b=c#d HTTPS://EXAMPLE.ORG mailto:a@example.org # #claim-1 \
                       rises/report.html ./a ../a /a ?a=b ?a=b:c a#b:c a?b=//c javascript%3Aalert(1) a%2F%2Fb";
        for address in allowed.split(' ').chain(["", "a file.pdf"]) {
            assert!(is_allowed(address), "{address}");
        }
        let refused = "javascript:alert(1) JavaScript:alert(1) jAvAsCrIpT: data:text/html,x vbscript:x file:///etc/passwd \
                       blob:x about:blank view-source:x ftp://a tel:1 //example.org ///example.org /..//example.org \
                       .//example.org \\\\example.org /\\example.org a:b httpx://a http%3a:x :a https\u{200b}://a";
        let spaced = [
            " javascript:alert(1)",
            "\u{a0}javascript:alert(1)",
            "java\tscript:alert(1)",
            "java\nscript:alert(1)",
            "\u{1}javascript:alert(1)",
            "/\t/example.org",
            "java script:alert(1)",
            "\u{85}javascript:x",
            "https://a\u{7f}",
        ];
        for address in refused.split(' ').chain(spaced) {
            assert!(!is_allowed(address), "{address:?}");
        }
    }
}
