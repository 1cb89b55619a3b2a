// MP4 films (H.264, yuv420p) through the program ffmpeg. The film appears under its name only when
// finish() succeeds.
//   Result<VideoWriter> video = VideoWriter::open("out/film.mp4", 512, 512, 60);
//   if (!video) return video.error();
//   for (…) if (Result<void> added = video->addFrame(frame); !added) return added;
//   return video->finish();
#pragma once

#include "demo/image/image.h"

#include <memory>

namespace penumbra {

class VideoWriter {
public:
    // Starts ffmpeg and creates the folder of `path`. Sides 1 … kMaxImageSide; odd ones get a black
    // line, which yuv420p needs. Error: ffmpeg is missing, the folder cannot be made.
    static Result<VideoWriter> open(const std::filesystem::path& path, std::uint32_t width,
                                    std::uint32_t height, std::uint32_t framesPerSecond);
    VideoWriter(VideoWriter&&) noexcept;
    VideoWriter& operator=(VideoWriter&&) noexcept;
    ~VideoWriter(); // without finish(): stops ffmpeg and removes what it wrote

    // A frame of the size given to open (asserted). Error: ffmpeg ended, with its last words.
    Result<void> addFrame(const Image8& frame);

    // Waits for ffmpeg and puts the film in its place. Nothing may be added after it.
    Result<void> finish();

private:
    struct State;
    explicit VideoWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> m_state; // null after finish() or a failure
};

} // namespace penumbra
