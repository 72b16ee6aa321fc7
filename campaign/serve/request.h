#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Requests and responses as values, without sockets.
namespace faultsweep {

/// What is asked for by GET or HEAD.
struct HttpRequest {
  std::vector<std::string> path;  ///< decoded, between the slashes: {"api", "campaigns"}.
  std::vector<std::pair<std::string, std::string>> query = {};  ///< decoded, in order.
};

struct HttpResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
  /// Content-Security-Policy: nothing may be loaded, run, framed or kept but styles that stand in
  /// it.
  std::string policy =
      "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";
  std::string remark = {};  ///< for the server's own terminal, never sent; "" = nothing.
};

/// Why a request is refused: place, cause and cure as of InputError, with HTTP's number for it.
struct HttpProblem {
  int status = 400;
  std::string place;  ///< "where", "path", "header Host".
  std::string cause, cure;
};
/// Ends the work on a request.
class HttpError : public std::runtime_error {
 public:
  explicit HttpError(HttpProblem problem)
      : std::runtime_error(problem.cause), problem_(std::move(problem)) {}
  HttpError(int status, std::string place, std::string cause, std::string cure)
      : HttpError(HttpProblem{status, std::move(place), std::move(cause), std::move(cure)}) {}
  const HttpProblem& problem() const { return problem_; }

 private:
  HttpProblem problem_;
};

/// {"error": {"status", "place", "cause", "cure"}}
HttpResponse error_response(const HttpProblem& problem);

/// "/api/campaigns?x=1": path and parameters, percent signs decoded, "+" of parameters a blank.
/// Throws HttpError: not a path (a whole URL, "*"), a "%" without two hexadecimal digits, what is
/// not UTF-8 or has control characters, a slash, "." or ".." as a part of the path, too many
/// parameters.
HttpRequest parse_target(std::string_view target);
inline constexpr std::size_t kMostParameters = 32;

/// What a request says of where it comes from: the values of each header, as often as it is there.
struct ClientHeaders {
  std::vector<std::string> host, origin, fetch_site;
};
/// Why a request is not of this server's own page or of somebody who types its address; none = it
/// is. A page of another site can reach a server on loopback: by its own name, which then leads to
/// 127.0.0.1 (Host), or by ours (Origin, Sec-Fetch-Site).
std::optional<HttpProblem> refusal(const ClientHeaders& headers, int port);

}  // namespace faultsweep
