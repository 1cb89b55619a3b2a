#include "assetc/build/folder_lock.h"

#include "assets/checksum.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <span>
#include <unistd.h>

namespace penumbra {

namespace {

// Byte 0 stands for the folder, one of the others for each asset. Locks of the open file (OFD)
// belong to this object; POSIX locks would go when anybody in the process closed the file.
constexpr std::int64_t kFolder = 0;

std::int64_t placeOf(std::string_view name)
{
    return static_cast<std::int64_t>(checksum(std::as_bytes(std::span(name))) >> 2) + 1;
}

bool setLock(int file, int command, short type, std::int64_t place)
{
    struct flock lock {};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    lock.l_start = place;
    lock.l_len = 1;
    int result = 0;
    do
        result = ::fcntl(file, command, &lock);
    while (result != 0 && errno == EINTR);
    return result == 0;
}

Error lockError()
{
    return {fmt::format("cannot lock the folder: {}; build on a file system with locks",
                        std::strerror(errno))};
}

} // namespace

Result<FolderLock> FolderLock::open(const std::filesystem::path& file)
{
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    if (error)
        return Error{fmt::format("{}: cannot create the folder: {}; choose another one",
                                 file.parent_path().string(), error.message())};
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0)
        return Error{fmt::format("{}: cannot open: {}; choose another folder", file.string(),
                                 std::strerror(errno))};
    return FolderLock(descriptor);
}

FolderLock::~FolderLock()
{
    if (m_file >= 0)
        ::close(m_file);
}

bool FolderLock::tryAlone()
{
    return setLock(m_file, F_OFD_SETLK, F_WRLCK, kFolder);
}

Result<void> FolderLock::share()
{
    return setLock(m_file, F_OFD_SETLKW, F_RDLCK, kFolder) ? Result<void>() : lockError();
}

Result<void> FolderLock::lockAsset(std::string_view name)
{
    return setLock(m_file, F_OFD_SETLKW, F_WRLCK, placeOf(name)) ? Result<void>() : lockError();
}

void FolderLock::unlockAsset(std::string_view name)
{
    setLock(m_file, F_OFD_SETLK, F_UNLCK, placeOf(name));
}

} // namespace penumbra
