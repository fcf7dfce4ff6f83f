//! The report as one page that needs no other file.

use super::Report;
use std::fmt::Write as _;

const STYLE: &str = "body{font:16px/1.5 'Helvetica Neue',Helvetica,Arial,'DejaVu Sans',sans-serif;color:#1a1a1a;\
max-width:46rem;margin:2rem auto;padding:0 1rem}h1{font-size:1.5rem}table{border-collapse:collapse;width:100%}\
th,td{text-align:left;vertical-align:top;padding:.35rem .8rem .35rem 0;border-bottom:1px solid #ddd}\
td:last-child{white-space:nowrap}.good{color:#00795a}.wrong{color:#b34700;font-weight:600}\
figure{margin:2rem 0}figcaption{color:#444;font-size:.95rem}svg{max-width:100%;height:auto}";

/// The page.
pub(super) fn html(report: &Report) -> String {
    let mut body = String::from("<h1>racbot demo</h1>\n<table>\n<tr><th>part</th><th>result</th><th></th></tr>\n");
    for part in &report.parts {
        let details: Vec<String> = part.details.iter().map(|line| escape(line)).collect();
        let (class, mark) = if part.good { ("good", "ok") } else { ("wrong", "wrong") };
        let _ = writeln!(
            body,
            "<tr><td>{}</td><td>{}</td><td class=\"{class}\">{mark}</td></tr>",
            escape(part.name),
            details.join("<br>")
        );
    }
    body.push_str("</table>\n");
    for picture in &report.pictures {
        let _ =
            writeln!(body, "<figure>\n{}<figcaption>{}</figcaption>\n</figure>", picture.svg, escape(&picture.caption));
    }
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>racbot demo</title>\
         <style>{STYLE}</style></head>\n<body>\n{body}</body></html>\n"
    )
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
