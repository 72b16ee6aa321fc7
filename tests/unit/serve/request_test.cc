#include "campaign/serve/request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

namespace faultsweep {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

/// The status with which a target is refused; 0 = it is not.
int refused_with(std::string_view target) {
  try {
    parse_target(target);
    return 0;
  } catch (const HttpError& error) {
    EXPECT_NE(error.problem().place, "");
    EXPECT_NE(error.problem().cause, "");
    EXPECT_NE(error.problem().cure, "");
    return error.problem().status;
  }
}

TEST(ParseTarget, DecodesPathAndParameters) {
  const HttpRequest request =
      parse_target("/api/campaigns/f%C3%BCr%20mich/ranking?where=offset+%3E+50%20m&by=a%2Bb&x");
  EXPECT_THAT(request.path, ElementsAre("api", "campaigns", "f\u00fcr mich", "ranking"));
  EXPECT_THAT(request.query,
              ElementsAre(Pair("where", "offset > 50 m"), Pair("by", "a+b"), Pair("x", "")));
  EXPECT_THAT(parse_target("/").path, ElementsAre());
  EXPECT_THAT(parse_target("/api/").path, ElementsAre("api"));
  EXPECT_THAT(parse_target("/api/?").query, ElementsAre());
  EXPECT_THAT(parse_target("/a+b").path, ElementsAre("a+b"));
  EXPECT_THAT(parse_target("/?a=1&&a=2=3").query, ElementsAre(Pair("a", "1"), Pair("a", "2=3")));
}

TEST(ParseTarget, RefusesWhatIsNoPathOfThisServer) {
  for (const char* target : {"",
                             "*",
                             "http://127.0.0.1/api",
                             "api",
                             "/a b",
                             "/a\tb",
                             "/a#b",
                             "/\x7f",
                             "/\xc3\xbc",
                             "/%",
                             "/%4",
                             "/%zz",
                             "/%4g",
                             "/?x=%",
                             "/%00",
                             "/%0a",
                             "/%7f",
                             "/?x=%00",
                             "/%c3",
                             "/%ff",
                             "/%c0%ae",
                             "/%ed%a0%80",
                             "/%f4%90%80%80",
                             "/%c2%85",
                             "/..",
                             "/api/../x",
                             "/%2e%2e/x",
                             "/a%2fb",
                             "/a%5cb",
                             "/./x"}) {
    EXPECT_EQ(refused_with(target), 400) << target;
  }
  EXPECT_EQ(refused_with(std::string_view("/a\0b", 4)), 400);
  std::string many = "/?a=1";
  for (std::size_t k = 1; k < kMostParameters; ++k) many += "&a=1";
  EXPECT_EQ(refused_with(many), 0);
  EXPECT_EQ(refused_with(many + "&a=1"), 400);
}

/// Whatever comes, what is accepted is text without a way out of a folder.
TEST(ParseTarget, WhatItAcceptsIsText) {
  std::mt19937 dice(36);
  const std::string_view alphabet = "/.%?&=+#\\ 0123456789abcdefABCDEF\x01\x80\xff:*";
  int n_accepted = 0;
  for (int k = 0; k < 200000; ++k) {
    std::string target = "/";
    for (auto n = dice() % 16; n > 0; --n) target += alphabet[dice() % alphabet.size()];
    try {
      const HttpRequest request = parse_target(target);
      ++n_accepted;
      for (const std::string& part : request.path) {
        ASSERT_NE(part, "..") << target;
        ASSERT_EQ(part.find_first_of("/\\"), std::string::npos) << target;
        ASSERT_NO_THROW(nlohmann::json(part).dump()) << target;  // which refuses what is not UTF-8
        for (const unsigned char c : part) ASSERT_GE(c, 0x20) << target;
      }
    } catch (const HttpError& error) {
      ASSERT_EQ(error.problem().status, 400) << target;
    }
  }
  EXPECT_GT(n_accepted, 1000);
}

TEST(Refusal, LetsOwnPagesAndTypedAddressesIn) {
  for (const ClientHeaders& headers :
       {ClientHeaders{{"127.0.0.1:8642"}, {}, {}}, ClientHeaders{{"localhost:8642"}, {}, {"none"}},
        ClientHeaders{{"127.0.0.1:8642"}, {"http://127.0.0.1:8642"}, {"same-origin"}}}) {
    EXPECT_FALSE(refusal(headers, 8642));
  }
  EXPECT_FALSE(refusal({{"localhost"}, {}, {}}, 80));
}

TEST(Refusal, KeepsOtherHostsAndOriginsOut) {
  const std::string own = "127.0.0.1:8642";
  const auto status = [](const ClientHeaders& headers) {
    const auto problem = refusal(headers, 8642);
    return problem ? problem->status : 0;
  };
  EXPECT_EQ(status({{}, {}, {}}), 400);
  EXPECT_EQ(status({{own, own}, {}, {}}), 400);
  for (const char* host : {"evil.example:8642", "127.0.0.1", "127.0.0.1:8643", "localhost",
                           "127.0.0.1:8642.evil.example", "user@127.0.0.1:8642", ""}) {
    EXPECT_EQ(status({{host}, {}, {}}), 421) << host;
  }
  for (const char* origin : {"http://evil.example", "https://127.0.0.1:8642", "null", "",
                             "http://127.0.0.1:8643", "http://127.0.0.1:8642.evil.example"}) {
    EXPECT_EQ(status({{own}, {origin}, {}}), 403) << origin;
  }
  EXPECT_EQ(status({{own}, {"http://" + own, "http://evil.example"}, {}}), 403);
  for (const char* site : {"cross-site", "same-site", "", "nonsense"})
    EXPECT_EQ(status({{own}, {}, {site}}), 403) << site;
}

TEST(ErrorResponse, IsJsonWithPlaceCauseAndCure) {
  const HttpResponse response = error_response({404, "path", "it is \"gone\"", "look"});
  EXPECT_EQ(response.status, 404);
  EXPECT_EQ(response.type, "application/json");
  const nlohmann::json error = nlohmann::json::parse(response.body).at("error");
  EXPECT_EQ(
      error,
      (nlohmann::json{
          {"status", 404}, {"place", "path"}, {"cause", "it is \"gone\""}, {"cure", "look"}}));
}

}  // namespace
}  // namespace faultsweep
