#include "assets/json_reader.h"

#include <gtest/gtest.h>

namespace penumbra {

TEST(JsonReader, DepthIsBoundedBeforeParsing)
{
    const auto nested = [](int depth) {
        return "{\"a\":" + std::string(static_cast<std::size_t>(depth - 1), '[') +
               std::string(static_cast<std::size_t>(depth - 1), ']') + "}";
    };
    EXPECT_TRUE(parseJson(nested(kMaxJsonDepth), 1 << 20));
    EXPECT_FALSE(parseJson(nested(kMaxJsonDepth + 1), 1 << 20));
    EXPECT_FALSE(parseJson(nested(60000), 1 << 20));
}

TEST(JsonReader, BracketsInStringsDoNotCount)
{
    const std::string text = "{\"a\":\"\\\"" + std::string(1000, '[') + "\"}";
    EXPECT_TRUE(parseJson(text, 1 << 20));
}

TEST(JsonReader, RefusesWhatIsNotAnObject)
{
    for (const char* text : {"", "[]", "1", "{", "{\"a\":}", "\xff\xfe"})
        EXPECT_FALSE(parseJson(text, 100)) << text;
    EXPECT_FALSE(parseJson("{\"a\": 1}", 5)); // larger than allowed
}

TEST(JsonReader, ProblemsNameTheirPlacesOnce)
{
    const auto document = parseJson(R"({"a":[{"b":-1}], "c":"text"})", 1000);
    ASSERT_TRUE(document);
    JsonProblems problems;
    const JsonReader root(*document, "file", problems);
    EXPECT_EQ(root.text("c"), "text");
    EXPECT_TRUE(problems.empty());
    EXPECT_EQ(root.member("a").element(0).count("b", 10), 0u);
    EXPECT_EQ(root.member("zzz").element(3).number("q", 0, 1), 0.0f);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].message, "file.a[0].b is -1, not a whole number from 0 to 10");
    EXPECT_EQ(problems[1].message, "file has no \"zzz\"");
}

TEST(JsonReader, RangesAndTypes)
{
    const auto document =
        parseJson(R"({"n":1e999, "f":1.5, "big":5, "list":[1,2,3], "t":true})", 1000);
    ASSERT_FALSE(document); // nlohmann refuses numbers beyond double
    const auto good = parseJson(R"({"f":1.5, "big":5, "list":[1,2,3], "t":true})", 1000);
    const auto refuses = [&](auto&& read) {
        JsonProblems problems;
        read(JsonReader(*good, "x", problems));
        return !problems.empty();
    };
    EXPECT_TRUE(refuses([](const JsonReader& r) { return r.count("f", 10); }));
    EXPECT_TRUE(refuses([](const JsonReader& r) { return r.count("big", 4); }));
    EXPECT_FALSE(refuses([](const JsonReader& r) { return r.count("big", 5); }));
    EXPECT_TRUE(refuses([](const JsonReader& r) { return r.number("f", 2, 3); }));
    EXPECT_FALSE(refuses([](const JsonReader& r) { return r.number("big", 2, 5); }));
    EXPECT_TRUE(refuses([](const JsonReader& r) { return r.member("list").length(2); }));
    EXPECT_TRUE(
        refuses([](const JsonReader& r) { return r.member("list").element(3).asCount(9); }));
    EXPECT_TRUE(refuses([](const JsonReader& r) { return r.text("t"); }));
}

TEST(JsonReader, SyntaxErrorsNameLineAndColumn)
{
    const auto document = parseJson("{\n  \"a\": 1,\n  \"b\" 2}", 100);
    ASSERT_FALSE(document);
    EXPECT_EQ(document.error().message, "not valid JSON at line 3, column 7");
}

// As files that people write are read: flags, no unknown members, places without a root.
TEST(JsonReader, FlagsAndUnknownMembers)
{
    const auto document = parseJson(R"({"a":{"on":true,"off":0,"zzz":1}, "list":[]})", 1000);
    ASSERT_TRUE(document);
    JsonProblems problems;
    const JsonReader root(*document, "", problems);
    EXPECT_TRUE(root.member("a").member("on").asFlag());
    root.refuseOthers({"a", "list"});
    EXPECT_TRUE(problems.empty());
    EXPECT_FALSE(root.member("a").member("off").asFlag());
    root.member("a").refuseOthers({"on", "off"});
    root.member("list").refuseOthers({});
    EXPECT_EQ(root.member("b").asText(), "");
    ASSERT_EQ(problems.size(), 4u);
    EXPECT_EQ(problems[0].message, "a.off is 0, not true or false");
    EXPECT_EQ(problems[1].message, "a has the unknown member \"zzz\"; known: on, off");
    EXPECT_EQ(problems[2].message, "list is an array of 0, not an object");
    EXPECT_EQ(problems[3].message, "has no \"b\"");
}

TEST(JsonReader, MembersThatAreThereTwiceHaveAPlace)
{
    const std::string text = R"({"a":[1,{"b":{"c":1,"c":2}},{"b":1}],"d":{"c":1},"e":0,"e":1})";
    JsonProblems problems;
    const auto document = parseJson(text, 1000, problems);
    ASSERT_TRUE(document);
    ASSERT_EQ(problems.size(), 2u);
    EXPECT_EQ(problems[0].message, "a[1].b has \"c\" twice; delete one");
    EXPECT_EQ(problems[1].message, "has \"e\" twice; delete one");
    EXPECT_EQ((*document)["e"], 1);
    EXPECT_TRUE(parseJson(text, 1000)); // where programs write
}

// What is quoted is short and cannot command a terminal.
TEST(JsonReader, ValuesAreQuotedSafely)
{
    const auto document = parseJson("{\"long\":\"" + std::string(500, 'x') +
                                        "\",\"escape\":\"\\u001b[2J\",\"list\":[1,2]}",
                                    10000);
    ASSERT_TRUE(document);
    JsonProblems problems;
    const JsonReader root(*document, "", problems);
    EXPECT_LE(root.member("long").quoted().size(), 42u);
    EXPECT_EQ(root.member("escape").quoted(), "\"\\u001b[2J\"");
    EXPECT_EQ(root.member("list").quoted(), "an array of 2");
    EXPECT_TRUE(problems.empty());
}

TEST(JsonReader, VersionsOfFilesThatPeopleWrite)
{
    for (const auto& [text, says] :
         {std::pair{"{}", "has no \"version\"; add \"version\": 1"},
          {R"({"version":2})", "version is 2, this program reads 1"},
          {R"({"version":"1"})", "version is \"1\", this program reads 1"}}) {
        const auto document = parseJson(text, 100);
        JsonProblems problems;
        JsonReader(*document, "", problems).checkVersion(1);
        ASSERT_EQ(problems.size(), 1u) << text;
        EXPECT_EQ(problems[0].message, says);
    }
}

} // namespace penumbra
