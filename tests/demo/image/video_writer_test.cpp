// Films through ffmpeg.
#include "demo/image/video_writer.h"

#include "runtime/file.h"

#include <cstdlib>
#include <gtest/gtest.h>

namespace penumbra {

namespace {

class VideoWriterTest : public testing::Test {
protected:
    std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "penumbra_video";

    void SetUp() override { std::filesystem::remove_all(folder); }
    void TearDown() override { std::filesystem::remove_all(folder); }

    [[nodiscard]] std::ptrdiff_t files() const
    {
        return std::distance(std::filesystem::directory_iterator(folder), {});
    }
};

Result<VideoWriter> openFilm(const std::filesystem::path& path)
{
    return VideoWriter::open(path, 63, 41, 30);
}

bool haveFfmpeg()
{
    return std::system("command -v ffmpeg >/dev/null") == 0;
}

TEST_F(VideoWriterTest, WritesAnMp4OfOddSize)
{
    ASSERT_TRUE(haveFfmpeg()) << "the program ffmpeg is missing: scripts/setup installs it";
    Result<VideoWriter> video = openFilm(folder / "film.mp4");
    ASSERT_TRUE(video) << video.error().message;
    for (std::uint8_t i = 0; i < 20; ++i)
        ASSERT_TRUE(video->addFrame(makeImage(63, 41, {i, 100, 200, 255})));
    EXPECT_FALSE(std::filesystem::exists(folder / "film.mp4"));
    const Result<void> finished = video->finish();
    ASSERT_TRUE(finished) << finished.error().message;
    EXPECT_EQ(files(), 1);
    const Result<std::vector<std::byte>> bytes = readFile(folder / "film.mp4", 1 << 20);
    ASSERT_TRUE(bytes) << bytes.error().message;
    ASSERT_GT(bytes->size(), 500u);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes->data()) + 4, 4), "ftyp");
}

TEST_F(VideoWriterTest, LeavesNothingWhenAbandoned)
{
    ASSERT_TRUE(haveFfmpeg()) << "the program ffmpeg is missing: scripts/setup installs it";
    {
        Result<VideoWriter> video = openFilm(folder / "film.mp4");
        ASSERT_TRUE(video) << video.error().message;
        ASSERT_TRUE(video->addFrame(makeImage(63, 41)));
    }
    EXPECT_EQ(files(), 0);
}

TEST_F(VideoWriterTest, AnEncoderThatFailsSaysWhy)
{
    ASSERT_TRUE(haveFfmpeg()) << "the program ffmpeg is missing: scripts/setup installs it";
    Result<VideoWriter> video = openFilm(folder / "film.mp4");
    ASSERT_TRUE(video) << video.error().message;
    std::filesystem::remove_all(folder); // ffmpeg cannot open its output
    std::string message;
    for (int i = 0; i < 2000 && message.empty(); ++i)
        if (const Result<void> added = video->addFrame(makeImage(63, 41)); !added)
            message = added.error().message;
    if (message.empty()) // ffmpeg had opened its output before the folder went
        message = video->finish().error().message;
    EXPECT_NE(message.find("film.mp4"), std::string::npos) << message;
}

TEST_F(VideoWriterTest, AMissingProgramNamesThePackage)
{
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", "/nonexistent", 1);
    const Result<VideoWriter> video = openFilm(folder / "film.mp4");
    ::setenv("PATH", path.c_str(), 1);
    ASSERT_FALSE(video);
    EXPECT_NE(video.error().message.find("package ffmpeg"), std::string::npos)
        << video.error().message;
    EXPECT_EQ(files(), 0);
}

} // namespace

} // namespace penumbra
