#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace faultsim {

/// A page in one file: styles and scripts stand in it, pictures are SVG, and a content security
/// policy lets no other script run, whatever a name in it may try. It asks for nothing, but where
/// it is told to, its own server. Without JavaScript all is there but filters, sorting and sliders.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title) : title_(std::move(title)) {}

  /// A heading, and its link at the top. @param id  a word, or words with "-" between.
  void section(const std::string& id, const std::string& title);
  void heading(const std::string& text);  ///< within a section.
  /// @param kind  "answer" (large), "faint" or "".
  void paragraph(const std::string& text, std::string_view kind = "");
  void chart(const std::string& svg);  ///< a drawing.
  /// Tables, and what pages of their own have: taken as it is.
  void add(std::string_view html) { body_ += html; }
  /// A further script, after the one that every page has, whose functions it may use.
  /// @param sha256  of it, in hexadecimal digits.
  void script(std::string_view text, std::string_view sha256);
  void may_ask_its_server() { asks_ = true; }
  /// Further styles, after those that every page has.
  void style(std::string_view css) { styles_ += css; }
  /// Data for the page's script, or for who reads the page: JSON in an element that nothing runs.
  /// @param id  of the element; "" = none.
  void data(const std::string& id, const std::string& json);
  /// Text to be opened, as it is.
  void details(const std::string& summary, const std::string& text);
  /// What body adds, or, where it throws InputError, the reason: an empty state says why.
  void unless_refused(const std::function<void()>& body);

  std::string finish() const;
  /// What stands below title and links, to be put into another page.
  const std::string& body() const { return body_; }
  /// Content-Security-Policy.
  std::string policy() const;

 private:
  std::string title_, body_, styles_, scripts_;
  std::string hashes_;  ///< of further scripts, as the policy names them.
  bool asks_ = false;
  std::vector<std::string> sections_;  ///< ids.
};

}  // namespace faultsim
