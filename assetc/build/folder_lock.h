// What two builds into one folder at the same time agree by: locks on one file. They end with the
// process that holds them, however it ends.
#pragma once

#include "runtime/result.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

namespace penumbra {

class FolderLock {
public:
    // Creates the file and its folders.
    static Result<FolderLock> open(const std::filesystem::path& file);
    FolderLock(FolderLock&& other) noexcept : m_file(std::exchange(other.m_file, -1)) {}
    FolderLock& operator=(FolderLock&&) = delete;
    ~FolderLock();

    // True where no other process works in the folder, and none will until share().
    [[nodiscard]] bool tryAlone();
    // From now on this process works in the folder. Waits while another one is alone in it.
    Result<void> share();

    // Keeps other processes from the asset `name`; waits while one has it. Does not keep threads of
    // this process from each other. At most one asset per thread, else two processes may wait for
    // each other for ever.
    Result<void> lockAsset(std::string_view name);
    void unlockAsset(std::string_view name);

private:
    explicit FolderLock(int file) : m_file(file) {}
    int m_file;
};

} // namespace penumbra
