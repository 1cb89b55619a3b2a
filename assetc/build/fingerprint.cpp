#include "assetc/build/fingerprint.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <fcntl.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace penumbra {

namespace {

std::int64_t nanoseconds(const timespec& time)
{
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// XXH3 with 128 bits: two contents of one hash would be one asset in the place of another.
std::string text(XXH128_hash_t hash)
{
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

// Empty where the file cannot be read to its end.
std::string hashFile(const std::filesystem::path& path)
{
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return {};
    std::array<char, 1 << 16> block;
    XXH3_state_t state;
    XXH3_128bits_reset(&state);
    ssize_t got = 0;
    do {
        got = ::read(file, block.data(), block.size());
        if (got > 0)
            XXH3_128bits_update(&state, block.data(), static_cast<std::size_t>(got));
    } while (got > 0 || (got < 0 && errno == EINTR));
    ::close(file);
    return got < 0 ? std::string() : text(XXH3_128bits_digest(&state));
}

} // namespace

FileStamp stampFile(const std::filesystem::path& path)
{
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
        return kNoFile;
    return {static_cast<std::uint64_t>(status.st_size), nanoseconds(status.st_ctim)};
}

std::int64_t fileClock()
{
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return nanoseconds(now);
}

std::int64_t waitForFileTick()
{
    timespec begin{}; // files may be stamped by this clock, which runs ahead of fileClock
    ::clock_gettime(CLOCK_REALTIME, &begin);
    std::int64_t now = fileClock();
    // Ticks take 1 to 10 ms. Who sets the clock back meanwhile is not waited for: 50 ms at most.
    constexpr int kMostSleeps = 250;
    constexpr std::chrono::microseconds kSleep(200);
    for (int i = 0; i < kMostSleeps && now <= nanoseconds(begin); ++i, now = fileClock())
        std::this_thread::sleep_for(kSleep);
    return now;
}

Fingerprint fingerprintFile(const std::filesystem::path& path, std::int64_t since)
{
    const FileStamp before = stampFile(path);
    if (before == kNoFile)
        return {kNoFile, {}};
    std::string hash = hashFile(path);
    const bool sure = before.changed < since && stampFile(path) == before;
    return {sure ? before : kAnyFile, std::move(hash)};
}

std::string contentHash(std::string_view bytes)
{
    return text(XXH3_128bits(bytes.data(), bytes.size()));
}

} // namespace penumbra
