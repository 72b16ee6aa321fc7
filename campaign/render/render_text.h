#pragma once

#include <string>

#include "campaign/render/answer.h"

namespace faultsweep {

/// The columns that a screen has, where nothing is said of it (a pipe).
constexpr std::size_t kScreenWidth = 100;

/// For a screen: sentences, then each table in one piece whatever the width. What does not vary
/// down a table is told as a sentence above it; headings take several lines; where columns still do
/// not fit, `extra` ones and then others are left out and named below it; where not even those that
/// are needed fit, each row is a paragraph. Charts are left to the page.
std::string render_text(const Answer& answer, std::size_t width = kScreenWidth);
std::string render_text(const AnswerTable& table, std::size_t width = kScreenWidth);
/// Text in lines of at most so many columns, broken at blanks; those that continue begin with
/// `indent` blanks. Words that are longer stand on lines of their own.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent = 0);

}  // namespace faultsweep
