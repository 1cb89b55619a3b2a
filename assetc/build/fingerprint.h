// How a build knows a file again: by its content, and, cheaper, by what the file system says of it.
#pragma once

#include "runtime/result.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace penumbra {

// Size and time of the last change (ctime: unlike mtime, nobody can set it back). Equal stamps of
// one path: equal content.
struct FileStamp {
    std::uint64_t size = 0;
    std::int64_t changed = 0; // ns since 1970, or one of the two below
    bool operator==(const FileStamp&) const = default;
};
constexpr FileStamp kNoFile{0, -1};  // no regular file there
constexpr FileStamp kAnyFile{0, -2}; // equal to the stamp of no file: look at the content

FileStamp stampFile(const std::filesystem::path& path);

// The clock that stamps files; a file changed after a call has `changed` at or above its result.
std::int64_t fileClock();

// Waits, some milliseconds, for a tick of that clock after which whatever was changed before the
// call has `changed` below it, and returns it.
std::int64_t waitForFileTick();

struct Fingerprint {
    FileStamp stamp;
    std::string hash; // of the content, 32 hexadecimal digits; empty where nothing can be read
};

// The stamp is kAnyFile where the file may have changed since `since` or changes at the moment:
// within one tick of the clock a file can change unseen.
Fingerprint fingerprintFile(const std::filesystem::path& path, std::int64_t since);

std::string contentHash(std::string_view bytes);

} // namespace penumbra
