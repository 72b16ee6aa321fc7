// The server itself, over sockets, with a handler of the test.
#include "campaign/serve/http_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "campaign/common/names.h"

namespace faultsweep {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A connection of a client that writes what it likes.
class Client {
 public:
  explicit Client(int port, const std::string& text = "")
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place = {};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience = {10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    is_connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&place), sizeof place) == 0;
    send(text);
  }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool is_connected() const { return is_connected_; }
  void send(const std::string& text) const {
    std::ignore = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// Waits until something comes.
  void read_some() const {
    char one = 0;
    EXPECT_EQ(::recv(socket_, &one, 1, 0), 1);
  }
  /// All that comes until the server closes.
  std::string read() const {
    std::string all;
    char part[4096];
    for (;;) {
      const ssize_t n = ::recv(socket_, part, sizeof part, 0);
      if (n <= 0) return all;
      all.append(part, static_cast<std::size_t>(n));
    }
  }

 private:
  int socket_;
  bool is_connected_ = false;
};

class HttpServerTest : public ::testing::Test {
 protected:
  void start(ServerSettings settings = {}) {
    server_ = std::make_unique<HttpServer>(std::move(settings), [this](const HttpRequest& request) {
      if (!request.path.empty() && request.path[0] == "slow") {
        while (!may_end_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      if (!request.path.empty() && request.path[0] == "large")
        return HttpResponse{200, "text/plain", std::string(8000000, 'x')};
      return HttpResponse{200, "text/plain", "asked for " + joined(request.path, "|")};
    });
    thread_ = std::thread([this] {
      try {
        server_->run();
      } catch (const StorageError& error) {
        ended_with_ = error.what();
        has_ended_ = true;
      }
    });
  }
  void TearDown() override {
    may_end_ = true;
    if (!server_) return;
    server_->stop();
    thread_.join();
  }
  std::string head(const std::string& first_line, const std::string& more = "") const {
    return concat(first_line, "\r\nHost: 127.0.0.1:", server_->port(), "\r\n", more, "\r\n");
  }
  std::string ask(const std::string& text) const { return Client(server_->port(), text).read(); }
  std::string get(const std::string& path) const { return ask(head("GET " + path + " HTTP/1.1")); }

  std::atomic<bool> may_end_ = false;
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
  std::string ended_with_;
  std::atomic<bool> has_ended_ = false;
};

std::string body_of(const std::string& response) {
  const std::size_t end = response.find("\r\n\r\n");
  return end == std::string::npos ? "" : response.substr(end + 4);
}

TEST_F(HttpServerTest, AnswersWithHeadersThatLetNothingElseIn) {
  start();
  const std::string response = get("/a/b?c=d");
  EXPECT_THAT(response, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_EQ(body_of(response), "asked for a|b");
  for (const char* header :
       {"Content-Security-Policy: default-src 'none'; ", "frame-ancestors 'none'",
        "X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer",
        "Cache-Control: no-store", "Content-Length: 13", "Connection: close"}) {
    EXPECT_THAT(response, HasSubstr(header));
  }
  EXPECT_THAT(response, Not(HasSubstr("Access-Control")));
  const std::string only_head = ask(head("HEAD /a/b HTTP/1.1"));
  EXPECT_THAT(only_head, HasSubstr("Content-Length: 13"));
  EXPECT_EQ(body_of(only_head), "");
}

/// One connection, two requests at once and a third after the first answer; the fourth is refused.
TEST_F(HttpServerTest, KeepsAConnectionForWhoAsksTo) {
  start();
  const auto kept = [&](const std::string& path) {
    return head("GET " + path + " HTTP/1.1", "Connection: keep-alive\r\n");
  };
  const Client client(server_->port(), kept("/a") + kept("/b"));
  client.send(kept("/c"));
  client.send(kept("/%zz"));
  client.send(kept("/d"));
  const std::string all = client.read();
  std::size_t at = 0;
  for (const char* next : {"HTTP/1.1 200 OK", "Connection: keep-alive", "asked for a",
                           "asked for b", "asked for c", "HTTP/1.1 400 ", "Connection: close"}) {
    at = all.find(next, at);
    ASSERT_NE(at, std::string::npos) << next << " is missing or out of order in\n" << all;
  }
  EXPECT_THAT(all, Not(HasSubstr("asked for d")));
}

TEST_F(HttpServerTest, AKeptConnectionThatIsIdleIsClosed) {
  ServerSettings settings;
  settings.limits.head_seconds = 0.2;
  start(settings);
  const Client client(server_->port(), head("GET /a HTTP/1.1", "Connection: keep-alive\r\n"));
  EXPECT_EQ(body_of(client.read()), "asked for a");
}

TEST_F(HttpServerTest, ListensOnLoopbackAlone) {
  start();
  EXPECT_EQ(server_->address(), concat("http://127.0.0.1:", server_->port(), "/"));
  const int other = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in place = {};  // another address of loopback, as good as any of the machine
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(server_->port()));
  inet_pton(AF_INET, "127.0.0.2", &place.sin_addr);
  EXPECT_NE(::connect(other, reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
  ::close(other);
  EXPECT_THROW(HttpServer({.port = server_->port()}, {}), InputError);
}

/// Whatever is refused is refused in JSON, with the same headers.
TEST_F(HttpServerTest, RefusesInJson) {
  start();
  const std::string own = concat("Host: 127.0.0.1:", server_->port(), "\r\n");
  const std::vector<std::pair<std::string, int>> requests = {
      {"nonsense\r\n\r\n", 400},
      {std::string("\0\0\0\r\n\r\n", 7), 400},
      {"GET / HTTP/1.1\r\nHost x\r\n\r\n", 400},
      {"GET / HTTP/1.1\r\n\r\n", 400},
      {"GET / HTTP/9.1\r\n" + own + "\r\n", 505},
      {"GET / HTTP/1.1\r\n" + own + own + "\r\n", 400},
      {"GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n", 421},
      {head("GET / HTTP/1.1", "Origin: http://evil.example\r\n"), 403},
      {head("GET / HTTP/1.1", "Sec-Fetch-Site: cross-site\r\n"), 403},
      {head("POST / HTTP/1.1"), 405},
      {head("BREW / HTTP/1.1"), 405},
      {head("OPTIONS * HTTP/1.1"), 405},
      {head("POST / HTTP/1.1", "Content-Length: 3\r\n") + "abc", 405},
      {head("GET / HTTP/1.1", "Content-Length: 3\r\n") + "abc", 413},
      {head("GET / HTTP/1.1", "Content-Length: 99999999999\r\n"), 413},
      {head("GET / HTTP/1.1", "Transfer-Encoding: chunked\r\n"), 413},
      {head("GET / HTTP/1.1", "Content-Length: -3\r\n"), 400},
      {head("GET /%zz HTTP/1.1"), 400},
      {head("GET http://127.0.0.1/ HTTP/1.1"), 400},
      {head("GET /" + std::string(5000, 'a') + " HTTP/1.1"), 414},
      {head("GET /" + std::string(100000, 'a') + " HTTP/1.1"), 431},
      {head("GET / HTTP/1.1", "X: " + std::string(9000, 'a') + "\r\n"), 431}};
  for (const auto& [text, status] : requests) {
    const std::string response = ask(text);
    EXPECT_THAT(response, StartsWith(concat("HTTP/1.1 ", status, " "))) << text.substr(0, 100);
    EXPECT_THAT(response, HasSubstr("Content-Security-Policy: default-src 'none'"));
    const nlohmann::json error = nlohmann::json::parse(body_of(response), nullptr, false);
    ASSERT_TRUE(error.is_object()) << response;
    EXPECT_EQ(error.at("error").at("status"), status) << text.substr(0, 100);
  }
}

/// As many as it may have send half a request and wait; the next one is answered all the same.
TEST_F(HttpServerTest, ClientsThatWaitHoldNobody) {
  start();
  std::vector<std::unique_ptr<Client>> slow;
  for (std::size_t k = 0; k < 3 * ServerLimits().connections; ++k)
    slow.push_back(std::make_unique<Client>(server_->port(), "GET / HTTP/1.1\r\nHo"));
  for (int k = 0; k < 5; ++k) {  // ask for much and do not read it
    slow.push_back(std::make_unique<Client>(server_->port(), head("GET /large HTTP/1.1")));
  }
  for (std::size_t k = 0; k < 2 * ServerLimits().connections; ++k) {  // have an answer and stay
    slow.push_back(std::make_unique<Client>(server_->port(),
                                            head("GET /a HTTP/1.1", "Connection: keep-alive\r\n")));
    slow.back()->read_some();
  }
  for (int k = 0; k < 20; ++k) {
    const auto began = std::chrono::steady_clock::now();
    EXPECT_EQ(body_of(get("/me")), "asked for me");
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(4)) << "held";
  }
}

TEST_F(HttpServerTest, WhoDoesNotFinishIsClosed) {
  ServerSettings settings;
  settings.limits.head_seconds = 0.2;
  start(settings);
  const Client client(server_->port(), "GET / HTTP/1.1\r\n");
  EXPECT_EQ(client.read(), "");
}

TEST_F(HttpServerTest, ALongAnswerHoldsNobodyAndTooManyAreRefused) {
  ServerSettings settings;
  settings.limits.unanswered = 3;
  settings.limits.threads = 3;
  start(settings);
  const Client first(server_->port(), head("GET /slow HTTP/1.1"));
  const Client second(server_->port(), head("GET /slow HTTP/1.1"));
  EXPECT_EQ(body_of(get("/me")), "asked for me");
  const Client third(server_->port(), head("GET /slow HTTP/1.1"));
  EXPECT_THAT(get("/me"), StartsWith("HTTP/1.1 503 "));
  may_end_ = true;
  for (const Client* one : {&first, &second, &third})
    EXPECT_EQ(body_of(one->read()), "asked for slow");
}

TEST_F(HttpServerTest, TooManyASecondAreRefused) {
  ServerSettings settings;
  settings.limits.per_second = 0.001;
  settings.limits.at_once = 3;
  start(settings);
  for (int k = 0; k < 3; ++k) EXPECT_THAT(get("/me"), StartsWith("HTTP/1.1 200 "));
  EXPECT_THAT(get("/me"), StartsWith("HTTP/1.1 429 "));
  EXPECT_THAT(get("/me"), HasSubstr("Retry-After: 1\r\n"));
}

TEST_F(HttpServerTest, EndsWithWhatItWatches) {
  ServerSettings settings;
  settings.watch = [] { throw StorageError("it is gone"); };
  start(settings);
  for (int k = 0; k < 500 && !has_ended_; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  TearDown();
  server_.reset();
  EXPECT_EQ(ended_with_, "it is gone");
}

}  // namespace
}  // namespace faultsweep
