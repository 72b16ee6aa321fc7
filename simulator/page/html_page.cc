#include "simulator/page/html_page.h"

#include "page_css.h"
#include "page_js.h"
#include "simulator/common/base64.h"
#include "simulator/common/errors.h"
#include "simulator/figure/svg.h"

namespace faultsim {
namespace {

using figure::escape_xml;

/// "'sha256-...'" of hexadecimal digits.
std::string source_of(std::string_view hex) {
  std::string hash;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    hash += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return concat("'sha256-", base64(hash), "'");
}

std::string with_blanks(std::string id) {
  for (char& c : id) c = c == '-' ? ' ' : c;
  return id;
}

}  // namespace

void HtmlPage::section(const std::string& id, const std::string& title) {
  sections_.push_back(id);
  body_ += concat("<h2 id=\"", escape_xml(id), "\">", escape_xml(title), "</h2>\n");
}

void HtmlPage::heading(const std::string& text) {
  body_ += concat("<h3>", escape_xml(text), "</h3>\n");
}

void HtmlPage::paragraph(const std::string& text, std::string_view kind) {
  body_ += concat("<p", kind.empty() ? std::string() : concat(" class=\"", kind, "\""), ">",
                  escape_xml(text), "</p>\n");
}

void HtmlPage::chart(const std::string& svg) { body_ += figure::on_page(svg); }

void HtmlPage::data(const std::string& id, const std::string& json) {
  body_ += concat("<script type=\"application/json\"",
                  id.empty() ? std::string() : concat(" id=\"", escape_xml(id), "\""), ">",
                  figure::json_in_html(json), "</script>\n");
}

void HtmlPage::details(const std::string& summary, const std::string& text) {
  body_ += concat("<details><summary>", escape_xml(summary), "</summary><pre>", escape_xml(text),
                  "</pre></details>\n");
}

void HtmlPage::unless_refused(const std::function<void()>& body) {
  try {
    body();
  } catch (const InputError& error) {
    paragraph(error.problems().front().what + "; " + error.problems().front().cure, "faint");
  }
}

void HtmlPage::script(std::string_view text, std::string_view sha256) {
  scripts_ += concat("<script>", text, "</script>\n");
  hashes_ += " " + source_of(sha256);
}

/// Nothing but its own scripts, known by their hashes, its styles and an empty icon.
std::string HtmlPage::policy() const {
  return concat("default-src 'none'; script-src ", source_of(embedded::page_js_sha256), hashes_,
                "; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'",
                asks_ ? "; connect-src 'self'" : "");
}

std::string HtmlPage::finish() const {
  std::string nav;
  for (const std::string& id : sections_) {
    nav += concat("<a href=\"#", escape_xml(id), "\">", escape_xml(with_blanks(id)), "</a>");
  }
  return concat(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"",
      policy(),
      "\">\n<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>",
      escape_xml(title_), "</title>\n<style>\n", embedded::page_css, styles_,
      "</style>\n</head>\n<body>\n<h1>", escape_xml(title_), "</h1>\n<nav>", nav, "</nav>\n", body_,
      "<script>", embedded::page_js, "</script>\n", scripts_, "</body>\n</html>\n");
}

}  // namespace faultsim
