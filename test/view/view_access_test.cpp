// Which requests the viewer answers: hosts, origins, tokens.
#include <gtest/gtest.h>
#include <set>

#include "montelux/view/view_access.h"

namespace montelux::testing {
namespace {

TEST(ViewAccess, HostIsTheAddressOfTheRequest) {
    EXPECT_TRUE(is_own_host("127.0.0.1:8080", "127.0.0.1", 8080, true));
    EXPECT_TRUE(is_own_host("localhost:8080", "127.0.0.1", 8080, true));
    EXPECT_TRUE(is_own_host("[::1]:8080", "::1", 8080, true));
    EXPECT_TRUE(is_own_host("192.168.1.5:8080", "192.168.1.5", 8080, false));
    EXPECT_TRUE(is_own_host("127.0.0.1", "127.0.0.1", 80, true));
}

TEST(ViewAccess, OtherHostsAreRefused) {
    for (const char* host :
         {"", ":8080", "127.0.0.1", "127.0.0.1:8081", "127.0.0.1:80800", "rebound.example:8080",
          "127.0.0.1.nip.io:8080", "localhost.example:8080", "127.0.0.2:8080", "::1:8080", "127.0.0.1:8080 ",
          " 127.0.0.1:8080", "user@127.0.0.1:8080", "LOCALHOST.:8080"})
        EXPECT_FALSE(is_own_host(host, "127.0.0.1", 8080, true)) << host;
    EXPECT_FALSE(is_own_host("localhost:8080", "192.168.1.5", 8080, false));
    EXPECT_FALSE(is_own_host("::1:8080", "::1", 8080, true)); // without brackets
}

TEST(ViewAccess, OriginIsAPageOfTheHost) {
    EXPECT_TRUE(is_own_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
    for (const char* origin :
         {"", "null", "https://127.0.0.1:8080", "http://127.0.0.1", "http://localhost:8080",
          "http://127.0.0.1:8080/", "http://127.0.0.1:8080.example", "http://example"})
        EXPECT_FALSE(is_own_origin(origin, "127.0.0.1:8080")) << origin;
}

TEST(ViewAccess, TokensAreLongAndDiffer) {
    std::set<std::string> tokens;
    for (int i = 0; i < 100; ++i) tokens.insert(ViewAccess::new_token());
    EXPECT_EQ(tokens.size(), 100u);
    for (const std::string& token : tokens) {
        EXPECT_EQ(token.size(), 32u);
        EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos) << token;
    }
}

TEST(ViewAccess, OnlyTheWholeTokenIsKnown) {
    const ViewAccess access("0123456789abcdef");
    EXPECT_TRUE(access.knows_token("0123456789abcdef"));
    for (const char* given :
         {"", "0", "0123456789abcde", "0123456789abcdef0", "0123456789abcdeF", "1123456789abcdef"})
        EXPECT_FALSE(access.knows_token(given)) << given;
}

TEST(ViewAccess, QueriesAreRead) {
    EXPECT_EQ(path_of("/live?token=abc"), "/live");
    EXPECT_EQ(path_of("/"), "/");
    EXPECT_EQ(query_value("/live?token=abc", "token"), "abc");
    EXPECT_EQ(query_value("/x?a=1&token=abc&b=2", "token"), "abc");
    EXPECT_EQ(query_value("/x?token=", "token"), "");
    for (const char* target :
         {"/live", "/live?", "/live?token", "/live?xtoken=abc", "/live?toke=abc", "/live?&&&"})
        EXPECT_EQ(query_value(target, "token"), "") << target;
}

} // namespace
} // namespace montelux::testing
