#include "runtime/file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace penumbra {

namespace {

struct Descriptor {
    int fd = -1;
    ~Descriptor()
    {
        if (fd >= 0)
            ::close(fd);
    }
};

Error systemError(const std::filesystem::path& path, const char* what)
{
    return {fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno))};
}

} // namespace

Result<FileHead> readFileHead(const std::filesystem::path& path, std::uint64_t maxBytes)
{
    // O_NONBLOCK: opening a FIFO must not hang; it has no effect on regular files.
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.fd < 0)
        return systemError(path, "cannot open");
    struct stat status {};
    if (::fstat(file.fd, &status) != 0)
        return systemError(path, "cannot stat");
    if (S_ISDIR(status.st_mode))
        return Error{path.string() + ": a folder; name a file in it"};
    if (!S_ISREG(status.st_mode))
        return Error{path.string() + ": not a regular file; copy what it gives into one"};
    FileHead head;
    head.fileBytes = static_cast<std::uint64_t>(status.st_size);
    std::vector<std::byte>& bytes = head.bytes;
    bytes.resize(std::min(head.fileBytes, maxBytes));
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = ::read(file.fd, bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return systemError(path, "cannot read");
        if (got == 0)
            return Error{path.string() + ": shrank while it was read"};
        done += static_cast<std::size_t>(got);
    }
    return head;
}

Result<std::vector<std::byte>> readFile(const std::filesystem::path& path, std::uint64_t maxBytes)
{
    auto head = readFileHead(path, maxBytes);
    if (!head)
        return head.error();
    if (head->fileBytes > maxBytes)
        return Error{fmt::format("{}: {} bytes, larger than the limit of {} bytes", path.string(),
                                 head->fileBytes, maxBytes)};
    return std::move(head->bytes);
}

Result<void> writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes)
{
    std::error_code ec;
    if (path.has_parent_path())
        std::filesystem::create_directories(path.parent_path(), ec);
    if (ec)
        return Error{fmt::format("{}: cannot create the folder: {}", path.parent_path().string(),
                                 ec.message())};

    if (std::filesystem::exists(path, ec) && !std::filesystem::is_regular_file(path, ec))
        return Error{fmt::format("{}: is not a regular file; it stays as it is", path.string())};
    std::string temporary = path.string() + ".XXXXXX";
    Descriptor file{::mkostemp(temporary.data(), O_CLOEXEC)};
    if (file.fd < 0)
        return systemError(path, "cannot create a file in its folder");
    ::fchmod(file.fd, 0644);
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t put = ::write(file.fd, bytes.data() + done, bytes.size() - done);
        if (put < 0 && errno == EINTR)
            continue;
        if (put < 0) {
            const Error error = systemError(path, "cannot write");
            ::unlink(temporary.c_str());
            return error;
        }
        done += static_cast<std::size_t>(put);
    }
    const int closed = ::close(std::exchange(file.fd, -1));
    if (closed != 0 || ::rename(temporary.c_str(), path.c_str()) != 0) {
        const Error error = systemError(path, "cannot replace");
        ::unlink(temporary.c_str());
        return error;
    }
    return {};
}

Result<void> writeFile(const std::filesystem::path& path, const std::string& text)
{
    return writeFile(path, std::as_bytes(std::span(text)));
}

Result<void> checkWritable(const std::filesystem::path& file)
{
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (std::filesystem::is_directory(status))
        return Error{file.string() + ": a folder; name a file in it"};
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
        return Error{file.string() + ": is not a regular file; it stays as it is"};
    if (status.type() == std::filesystem::file_type::none)
        return Error{fmt::format("{}: cannot be written: {}; choose another name or folder",
                                 file.string(), error.message())};
    // The nearest folder that is there; those below it will be made.
    std::filesystem::path folder = std::filesystem::absolute(file, error).parent_path();
    while (!std::filesystem::exists(folder, error) && folder.has_relative_path())
        folder = folder.parent_path();
    if (!std::filesystem::is_directory(folder, error))
        return Error{fmt::format("{}: cannot be written: {} is no folder; choose another name",
                                 file.string(), folder.string())};
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return Error{fmt::format("{}: cannot be written: {}: {}; choose another folder",
                                 file.string(), folder.string(), std::strerror(errno))};
    return {};
}

} // namespace penumbra
