#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Drawing as SVG text. Lengths are CSS pixels (1/96 inch), x to the right, y down. No ids, no
/// styles, no scripts: any number of drawings can stand in one page, and the same calls give the
/// same bytes.
namespace faultsim::figure {

struct Point {
  double x = 0, y = 0;
};
/// A rectangle. @pre width, height ≥ 0.
struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  double right() const { return x + width; }
  double bottom() const { return y + height; }
};
struct Stroke {
  std::string colour = "#000000";
  double width = 1;
  std::string dash = {};  ///< lengths of dashes and gaps, "6 3"; "" = solid.
};
enum class Anchor { start, middle, end };
struct TextStyle {
  double size = 12;
  std::string colour = "#222222";
  Anchor anchor = Anchor::start;
  bool bold = false;
  double rotation = 0;  ///< degrees, clockwise, about the place.
};

/// Text of an XML document: & < > " ' are escaped, bytes that are not valid UTF-8 and characters
/// that XML 1.0 does not know become U+FFFD.
std::string escape_xml(std::string_view text);
/// The number with at most two decimals, without a trailing zero, whatever the locale.
/// InternalError unless it is finite.
std::string coordinate(double value);
/// Width of a text as a sans-serif face draws it, px: an estimate on the wide side.
double text_width(std::string_view text, double size);
/// The text, or as much of it with "…" as fits into the width; "" where not even that does.
std::string fitted(const std::string& text, double width, double size);

/// JSON as the text of a script element of a page: no "<" in it can end the element.
std::string json_in_html(const std::string& json);

/// A drawing as a part of a page: in a box of class "chart", which scrolls where a screen is
/// narrower than the drawing can be read at.
std::string on_page(const std::string& svg);

class Svg {
 public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;

  /// @param title  what a reader who cannot see the picture is told.
  Svg(double width, double height, const std::string& title);
  double width() const { return width_; }
  double height() const { return height_; }

  void line(Point from, Point to, const Stroke& stroke);
  /// Nothing for fewer than two points.
  void polyline(const std::vector<Point>& points, const Stroke& stroke);
  /// @param fill  "none" = not filled.
  void polygon(const std::vector<Point>& points, const std::string& fill,
               const Stroke& stroke = {"none", 0});
  void rect(const Box& box, const std::string& fill, const Stroke& stroke = {"none", 0});
  void circle(Point centre, double radius, const std::string& fill,
              const Stroke& stroke = {"none", 0});
  /// The place is on the base line.
  void text(Point place, const std::string& text, const TextStyle& style = {});
  /// What follows belongs together, for a page that changes it: attributes such as data-fault.
  void begin_group(const Attributes& attributes);
  void end_group();
  /// The document. @pre all groups have ended.
  std::string finish();

 private:
  double width_, height_;
  int n_open_ = 0;
  std::string body_;
};

}  // namespace faultsim::figure
