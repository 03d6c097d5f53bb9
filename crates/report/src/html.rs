//! Pieces of HTML.

/// A text as it stands in HTML, in attributes too.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;").replace('\'', "&#39;")
}

/// A text with words in backquotes as code.
pub fn prose(text: &str) -> String {
    let mut out = String::new();
    for (k, part) in escaped(text).split('`').enumerate() {
        out += &if k % 2 == 1 { format!("<code>{part}</code>") } else { part.to_string() };
    }
    out
}

/// A section with a heading; nothing without content.
pub fn section(id: &str, title: &str, body: &str) -> String {
    if body.is_empty() {
        return String::new();
    }
    format!("<section id=\"{id}\" aria-labelledby=\"{id}-title\"><h2 id=\"{id}-title\">{title}</h2>{body}</section>\n")
}

/// A table with a caption for those who do not see it; nothing without rows. Columns of numbers stand to the right.
pub fn table(caption: &str, head: &[String], rows: &[Vec<String>]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let is_number =
        |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || "-−–±(∞".contains(c)) || text.is_empty();
    let right: Vec<bool> =
        (0..head.len()).map(|k| rows.iter().all(|row| row.get(k).is_none_or(|text| is_number(text)))).collect();
    let class = |k: usize| if right.get(k) == Some(&true) { " class=\"number\"" } else { "" };
    let heads: String =
        (head.iter().enumerate()).map(|(k, t)| format!("<th scope=\"col\"{}>{}</th>", class(k), escaped(t))).collect();
    let line = |row: &Vec<String>| -> String {
        let cells = row.iter().enumerate();
        cells.map(|(k, text)| format!("<td{}>{}</td>", class(k), prose(text))).collect()
    };
    let body: String = rows.iter().map(|row| format!("<tr>{}</tr>", line(row))).collect();
    format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table><caption>{0}</caption>\
         <thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table></div>",
        escaped(caption)
    )
}

/// Names with what belongs to them.
pub fn list(entries: &[(String, String)]) -> String {
    let line =
        |(name, text): &(String, String)| format!("<div><dt>{}</dt><dd>{}</dd></div>", escaped(name), prose(text));
    if entries.is_empty() {
        String::new()
    } else {
        format!("<dl>{}</dl>", entries.iter().map(line).collect::<String>())
    }
}

/// JSON as it stands within a script: nothing in it ends the script.
pub fn json<T: serde::Serialize>(value: &T) -> String {
    serde_json::to_string(value).unwrap_or_else(|_| "null".into()).replace('<', "\\u003c")
}
