#include "campaign/serve/request.h"

#include <algorithm>

#include "campaign/common/json.h"
#include "campaign/common/names.h"
#include "simulator/files/json_text.h"

namespace faultsweep {
namespace {

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// How many bytes of UTF-8 a character has that begins with this one; 0 = none does.
std::size_t length_of_character(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first <= 0xdf) return 2;
  if (first >= 0xe0 && first <= 0xef) return 3;
  return first >= 0xf0 && first <= 0xf4 ? 4 : 0;
}

/// Well-formed (no overlong forms, no surrogates, nothing above U+10FFFF) and without control
/// characters.
bool is_text(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
    const std::size_t n = length_of_character(byte(0));
    if (n == 0 || at + n > text.size()) return false;
    char32_t code = n == 1 ? byte(0) : byte(0) & (0x7fU >> n);
    for (std::size_t k = 1; k < n; ++k) {
      if ((byte(k) & 0xc0U) != 0x80U) return false;
      code = code << 6U | (byte(k) & 0x3fU);
    }
    const bool is_control = code < 0x20 || (code >= 0x7f && code < 0xa0);
    const bool is_overlong = (n == 3 && code < 0x800) || (n == 4 && code < 0x10000);
    if (is_control || is_overlong || (code >= 0xd800 && code < 0xe000) || code > 0x10ffff)
      return false;
    at += n;
  }
  return true;
}

std::string decoded(std::string_view text, const char* place, bool plus_is_blank) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_blank) {
      out += ' ';
    } else if (text[i] != '%') {
      out += text[i];
    } else {
      const int high = i + 2 < text.size() ? digit_of(text[i + 1]) : -1;
      const int low = high < 0 ? -1 : digit_of(text[i + 2]);
      if (low < 0) {
        throw HttpError(400, place, "a % is not followed by two hexadecimal digits",
                        "write %25 for a percent sign");
      }
      out += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  if (!is_text(out)) {
    throw HttpError(400, place, "it is not UTF-8, or contains control characters",
                    "write texts as UTF-8, each byte beyond ASCII as %XX");
  }
  return out;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string> parse_path(std::string_view path) {
  std::vector<std::string> parts;
  for (const std::string_view part : split(path, '/')) {
    parts.push_back(decoded(part, "path", false));
    const std::string& name = parts.back();
    if (name == "." || name == ".." || name.find_first_of("/\\") != std::string::npos)
      throw HttpError(400, "path", "a part of it is . or .., or contains a slash",
                      "GET /api lists what there is");
  }
  if (parts.back().empty()) parts.pop_back();  // "/api/" is "/api"
  return parts;
}

}  // namespace

HttpRequest parse_target(std::string_view target) {
  if (!target.starts_with('/') ||
      std::ranges::any_of(target, [](char c) { return c <= ' ' || c > '~' || c == '#'; })) {
    throw HttpError(400, "path", "the target is not a path of this server",
                    "write it as /api/campaigns?x=1, other characters as %XX");
  }
  const std::size_t end = target.find('?');
  HttpRequest request{parse_path(target.substr(1, end == std::string_view::npos ? end : end - 1))};
  if (end == std::string_view::npos) return request;
  for (const std::string_view part : split(target.substr(end + 1), '&')) {
    if (part.empty()) continue;
    if (request.query.size() == kMostParameters) {
      throw HttpError(400, "parameters", concat("there are more than ", kMostParameters),
                      "GET /api lists those of each path");
    }
    const std::size_t equals = part.find('=');
    const bool has_value = equals != std::string_view::npos;
    request.query.emplace_back(
        decoded(part.substr(0, equals), "parameters", true),
        has_value ? decoded(part.substr(equals + 1), "parameters", true) : std::string());
  }
  return request;
}

HttpResponse error_response(const HttpProblem& problem) {
  const ordered_json error = {{"status", problem.status},
                              {"place", problem.place},
                              {"cause", problem.cause},
                              {"cure", problem.cure}};
  return {problem.status, "application/json", faultsim::json_text(ordered_json{{"error", error}})};
}

std::optional<HttpProblem> refusal(const ClientHeaders& headers, int port) {
  std::vector<std::string> names;
  for (const char* host : {"127.0.0.1", "localhost"}) {
    names.push_back(concat(host, ":", port));
    constexpr int kDefaultPort = 80;
    if (port == kDefaultPort) names.emplace_back(host);
  }
  const auto is_one_of = [](const std::vector<std::string>& given, auto&& is_ours) {
    return given.size() == 1 && is_ours(given.front());
  };
  if (!is_one_of(headers.host, [&](const std::string& host) { return contains(names, host); })) {
    constexpr int kMisdirected = 421;
    return HttpProblem{headers.host.size() == 1 ? kMisdirected : 400, "header Host",
                       "the request is for another host", "ask for " + names.front()};
  }
  const auto is_our_origin = [&](const std::string& origin) {
    return std::ranges::any_of(names,
                               [&](const std::string& name) { return origin == "http://" + name; });
  };
  constexpr int kForbidden = 403;
  if (!headers.origin.empty() && !is_one_of(headers.origin, is_our_origin)) {
    return HttpProblem{kForbidden, "header Origin", "the request is from a page of another origin",
                       "open the server's own address"};
  }
  const auto is_own = [](const std::string& site) {
    return site == "same-origin" || site == "none";
  };
  if (!headers.fetch_site.empty() && !is_one_of(headers.fetch_site, is_own)) {
    return HttpProblem{kForbidden, "header Sec-Fetch-Site",
                       "the request is from a page of another site",
                       "open the server's own address"};
  }
  return std::nullopt;
}

}  // namespace faultsweep
