#include "demo/image/video_writer.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace penumbra {

namespace {

constexpr const char* kProgram = "ffmpeg";

struct Descriptor {
    int fd = -1;
    Descriptor() = default;
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close(); }
    void close()
    {
        if (fd >= 0)
            ::close(std::exchange(fd, -1));
    }
};

std::string lastWords(int file)
{
    std::string text(2000, '\0');
    const ssize_t got = ::pread(file, text.data(), text.size(), 0);
    text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    while (!text.empty() && text.back() == '\n')
        text.pop_back();
    return text;
}

} // namespace

struct VideoWriter::State {
    std::filesystem::path path, temporary;
    std::uint32_t width = 0, height = 0;
    pid_t process = -1;
    // A socket and not a pipe: MSG_NOSIGNAL makes an ffmpeg that ended an error, where a pipe would
    // raise SIGPIPE.
    Descriptor frames;
    Descriptor errors; // what ffmpeg prints
    bool finished = false;

    // The exit status; -1: none.
    int wait()
    {
        frames.close();
        int status = -1;
        while (process > 0 && ::waitpid(process, &status, 0) < 0 && errno == EINTR) {
        }
        process = -1;
        return status;
    }

    ~State()
    {
        if (process > 0)
            ::kill(process, SIGKILL);
        wait();
        if (!finished)
            ::unlink(temporary.c_str());
    }
};

VideoWriter::VideoWriter(std::unique_ptr<State> state) : m_state(std::move(state)) {}
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

Result<VideoWriter> VideoWriter::open(const std::filesystem::path& path, std::uint32_t width,
                                      std::uint32_t height, std::uint32_t framesPerSecond)
{
    PENUMBRA_ASSERT(width >= 1 && width <= kMaxImageSide && height >= 1 &&
                        height <= kMaxImageSide && framesPerSecond >= 1,
                    "{} x {} at {} frames per second", width, height, framesPerSecond);
    std::error_code ec;
    if (path.has_parent_path())
        std::filesystem::create_directories(path.parent_path(), ec);
    if (ec)
        return Error{fmt::format("{}: cannot create the folder: {}", path.parent_path().string(),
                                 ec.message())};
    auto state = std::make_unique<State>();
    state->path = path;
    state->temporary = fmt::format("{}.{}.partial", path.string(), ::getpid());
    state->width = width;
    state->height = height;
    int ends[2];
    state->errors.fd = ::memfd_create("ffmpeg", MFD_CLOEXEC);
    if (state->errors.fd < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
        return Error{fmt::format("{}: cannot connect to {}: {}", path.string(), kProgram,
                                 std::strerror(errno))};
    state->frames.fd = ends[0];
    Descriptor input;
    input.fd = ends[1];

    const std::string size = fmt::format("{}x{}", width, height),
                      rate = std::to_string(framesPerSecond);
    // "file:" keeps a name with a colon from being read as a protocol. bitexact: no version or date
    // in the file.
    const std::string out = "file:" + state->temporary.string();
    const char* arguments[] = {
        kProgram,
        "-hide_banner",
        "-loglevel",
        "error",
        "-nostdin",
        "-y",
        "-f",
        "rawvideo",
        "-pixel_format",
        "rgba",
        "-video_size",
        size.c_str(),
        "-framerate",
        rate.c_str(),
        "-i",
        "pipe:0",
        "-vf",
        "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
        "-c:v",
        "libx264",
        "-preset",
        "medium",
        "-crf",
        "18",
        "-pix_fmt",
        "yuv420p",
        "-colorspace",
        "bt709",
        "-color_primaries",
        "bt709",
        "-color_trc",
        "bt709",
        "-flags",
        "+bitexact",
        "-fflags",
        "+bitexact",
        "-movflags",
        "+faststart",
        "-f",
        "mp4",
        out.c_str(),
        nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input.fd, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, state->errors.fd, STDERR_FILENO);
    const int failed = ::posix_spawnp(&state->process, kProgram, &actions, nullptr,
                                      const_cast<char* const*>(arguments), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) {
        state->process = -1;
        return Error{fmt::format(
            "{}: cannot start {}: {}; films need the package ffmpeg (apt install ffmpeg)",
            path.string(), kProgram, std::strerror(failed))};
    }
    return VideoWriter(std::move(state));
}

Result<void> VideoWriter::addFrame(const Image8& frame)
{
    PENUMBRA_ASSERT(m_state != nullptr, "a frame after finish() or a failure");
    PENUMBRA_ASSERT(frame.width == m_state->width && frame.height == m_state->height &&
                        frame.rgba.size() == std::size_t{4} * frame.width * frame.height,
                    "a frame of {} x {} in a film of {} x {}", frame.width, frame.height,
                    m_state->width, m_state->height);
    for (std::size_t done = 0; done < frame.rgba.size();) {
        const ssize_t sent = ::send(m_state->frames.fd, frame.rgba.data() + done,
                                    frame.rgba.size() - done, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR)
            continue;
        if (sent < 0) {
            m_state->wait();
            const Error error{fmt::format("{}: {} ended: {}", m_state->path.string(), kProgram,
                                          lastWords(m_state->errors.fd))};
            m_state.reset();
            return error;
        }
        done += static_cast<std::size_t>(sent);
    }
    return {};
}

Result<void> VideoWriter::finish()
{
    PENUMBRA_ASSERT(m_state != nullptr, "finish() twice or after a failure");
    const std::unique_ptr<State> state = std::move(m_state);
    const int status = state->wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return Error{fmt::format("{}: {} failed: {}", state->path.string(), kProgram,
                                 lastWords(state->errors.fd))};
    if (::rename(state->temporary.c_str(), state->path.c_str()) != 0)
        return Error{
            fmt::format("{}: cannot replace: {}", state->path.string(), std::strerror(errno))};
    state->finished = true;
    return {};
}

} // namespace penumbra
