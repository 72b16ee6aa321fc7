#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace faultsim::figure {

/// What is wrong with a document of elements, attributes and texts as XML; "" = nothing. Enough for
/// what we write: no declarations, comments or sections.
inline std::string xml_problem(std::string_view text) {
  std::vector<std::string> open;
  const auto text_problem = [](std::string_view part) -> std::string {
    for (std::size_t k = 0; k < part.size(); ++k) {
      const auto c = static_cast<unsigned char>(part[k]);
      if (c == '<' || (c < 0x20 && c != '\n' && c != '\t')) return "a character in a text";
      if (c != '&') continue;
      bool known = false;
      for (const char* entity : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"}) {
        known = known || part.substr(k).starts_with(entity);
      }
      if (!known) return "a bare &";
    }
    return "";
  };
  while (!text.empty()) {
    const std::size_t begin = text.find('<');
    if (const auto problem = text_problem(text.substr(0, begin)); !problem.empty()) return problem;
    if (begin == std::string_view::npos) break;
    bool quoted = false;
    std::size_t end = begin + 1;
    for (; end < text.size() && (quoted || text[end] != '>'); ++end) {
      if (text[end] == '"') quoted = !quoted;
      if (text[end] == '<') return "< within a tag";
    }
    if (end == text.size()) return "a tag does not end";
    std::string_view tag = text.substr(begin + 1, end - begin - 1);
    text.remove_prefix(end + 1);
    const bool closes = tag.starts_with('/'), is_empty = tag.ends_with('/');
    if (closes) tag.remove_prefix(1);
    const std::string name(tag.substr(0, tag.find_first_of(" /\n")));
    if (const auto problem = text_problem(tag); !problem.empty()) return problem;
    if (!closes && !is_empty) open.push_back(name);
    if (closes && (open.empty() || open.back() != name)) return "</" + name + "> ends nothing";
    if (closes) open.pop_back();
  }
  return open.empty() ? "" : "<" + open.back() + "> does not end";
}

}  // namespace faultsim::figure
