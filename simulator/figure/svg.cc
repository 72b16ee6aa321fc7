#include "simulator/figure/svg.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "simulator/common/errors.h"
#include "simulator/common/printable.h"
#include "simulator/common/text.h"

namespace faultsim::figure {
namespace {

constexpr const char* kFont = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif";
constexpr const char* kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// Bytes of the UTF-8 character that begins here; 0 where none does, or none that XML knows.
std::size_t character_length(std::string_view text) {
  const Character one = character_at(text, 0);
  const bool is_known = one.code < 0x20 ? one.code == '\t' || one.code == '\n' || one.code == '\r'
                                        : one.code != 0xFFFE && one.code != 0xFFFF;
  return one.valid && is_known ? one.size : 0;
}

std::string pair_of(const char* x, const char* y, Point p) {
  return concat(" ", x, "=\"", coordinate(p.x), "\" ", y, "=\"", coordinate(p.y), "\"");
}

std::string stroke_text(const Stroke& stroke) {
  if (stroke.colour == "none") return "";
  std::string text =
      concat(" stroke=\"", stroke.colour, "\" stroke-width=\"", coordinate(stroke.width), "\"");
  if (!stroke.dash.empty()) text += " stroke-dasharray=\"" + stroke.dash + "\"";
  return text;
}

std::string points_text(const std::vector<Point>& points) {
  return joined(points, " ",
                [](const Point& p) { return coordinate(p.x) + "," + coordinate(p.y); });
}

}  // namespace

std::string escape_xml(std::string_view text) {
  constexpr std::string_view kSpecial = "&<>\"'";
  constexpr const char* kEscapes[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  std::string escaped;
  while (!text.empty()) {
    const std::size_t n = character_length(text);
    if (n == 0) {
      escaped += kReplacement;
      text.remove_prefix(1);
      continue;
    }
    const std::size_t k = kSpecial.find(text[0]);
    if (k == std::string_view::npos) {
      escaped += text.substr(0, n);
    } else {
      escaped += kEscapes[k];
    }
    text.remove_prefix(n);
  }
  return escaped;
}

std::string coordinate(double value) {
  FAULTSIM_DEMAND(std::isfinite(value), "a coordinate ", value);
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, 2).ptr;
  std::string number(text, end);
  while (number.back() == '0') number.pop_back();
  if (number.back() == '.') number.pop_back();
  return number == "-0" ? "0" : number;
}

double text_width(std::string_view text, double size) {
  double units = 0;
  while (!text.empty()) {
    const std::size_t n = std::max<std::size_t>(character_length(text), 1);
    const char c = text[0];
    const bool combines = n == 2 && text[0] == '\xCC';  // U+0300 to U+033F
    const bool narrow = n == 1 && std::string_view(" .,:;!|ijltf()[]'").find(c) != text.npos;
    const bool wide = n == 1 && (std::string_view("mwMW%@").find(c) != text.npos);
    units += combines                         ? 0
             : narrow                         ? 0.36
             : wide                           ? 0.92
             : n == 1 && c >= 'A' && c <= 'Z' ? 0.7
                                              : 0.6;
    text.remove_prefix(n);
  }
  return units * size;
}

std::string fitted(const std::string& text, double width, double size) {
  if (text_width(text, size) <= width) return text;
  std::string part;
  std::string_view rest = text;
  const double room = width - text_width("…", size);
  while (!rest.empty()) {
    const std::size_t n = std::max<std::size_t>(character_length(rest), 1);
    if (text_width(part + std::string(rest.substr(0, n)), size) > room) break;
    part += rest.substr(0, n);
    rest.remove_prefix(n);
  }
  while (!part.empty() && part.back() == ' ') part.pop_back();
  return part.empty() ? "" : part + "…";
}

std::string json_in_html(const std::string& json) {
  constexpr std::string_view kEscape = "\\u003c";
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) c == '<' ? escaped += kEscape : escaped += c;
  return escaped;
}

std::string on_page(const std::string& svg) { return "<div class=\"chart\">" + svg + "</div>\n"; }

Svg::Svg(double width, double height, const std::string& title) : width_(width), height_(height) {
  const std::string w = coordinate(width), h = coordinate(height);
  body_ = concat("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", w, "\" height=\"", h,
                 "\" viewBox=\"0 0 ", w, " ", h, "\" role=\"img\" font-family=\"", kFont,
                 "\" fill=\"none\">\n<title>", escape_xml(title), "</title>\n");
  rect({0, 0, width, height}, "#ffffff");
}

void Svg::line(Point from, Point to, const Stroke& stroke) {
  body_ += concat("<line", pair_of("x1", "y1", from), pair_of("x2", "y2", to), stroke_text(stroke),
                  "/>\n");
}

void Svg::polyline(const std::vector<Point>& points, const Stroke& stroke) {
  if (points.size() < 2) return;
  body_ += concat("<polyline points=\"", points_text(points), "\"", stroke_text(stroke),
                  " stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n");
}

void Svg::polygon(const std::vector<Point>& points, const std::string& fill, const Stroke& stroke) {
  body_ += concat("<polygon points=\"", points_text(points), "\" fill=\"", fill, "\"",
                  stroke_text(stroke), "/>\n");
}

void Svg::rect(const Box& box, const std::string& fill, const Stroke& stroke) {
  FAULTSIM_DEMAND(box.width >= 0 && box.height >= 0, box.width, " x ", box.height);
  body_ += concat("<rect", pair_of("x", "y", {box.x, box.y}),
                  pair_of("width", "height", {box.width, box.height}), " fill=\"", fill, "\"",
                  stroke_text(stroke), "/>\n");
}

void Svg::circle(Point centre, double radius, const std::string& fill, const Stroke& stroke) {
  body_ += concat("<circle", pair_of("cx", "cy", centre), " r=\"", coordinate(radius), "\" fill=\"",
                  fill, "\"", stroke_text(stroke), "/>\n");
}

void Svg::text(Point place, const std::string& text, const TextStyle& style) {
  if (text.empty()) return;
  body_ += concat("<text", pair_of("x", "y", place), " font-size=\"", coordinate(style.size),
                  "\" fill=\"", style.colour, "\"");
  if (style.anchor != Anchor::start) {
    body_ += concat(" text-anchor=\"", style.anchor == Anchor::middle ? "middle" : "end", "\"");
  }
  if (style.bold) body_ += " font-weight=\"bold\"";
  if (style.rotation != 0) {
    body_ += concat(" transform=\"rotate(", coordinate(style.rotation), " ", coordinate(place.x),
                    " ", coordinate(place.y), ")\"");
  }
  body_ += ">" + escape_xml(text) + "</text>\n";
}

void Svg::begin_group(const Attributes& attributes) {
  body_ += "<g";
  for (const auto& [name, value] : attributes) {
    body_ += concat(" ", name, "=\"", escape_xml(value), "\"");
  }
  body_ += ">\n";
  ++n_open_;
}

void Svg::end_group() {
  FAULTSIM_DEMAND(n_open_ > 0, "no group to end");
  body_ += "</g>\n";
  --n_open_;
}

std::string Svg::finish() {
  FAULTSIM_DEMAND(n_open_ == 0, n_open_, " groups are open");
  return body_ + "</svg>\n";
}

}  // namespace faultsim::figure
