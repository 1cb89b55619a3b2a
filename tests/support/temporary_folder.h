// A folder that lives as long as the object, for fixtures that a test writes itself.
#pragma once

#include "runtime/file.h"

#include <cstdlib>
#include <gtest/gtest.h>

namespace penumbra {

class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "penumbra-XXXXXX").string();
        m_path = ::mkdtemp(name.data());
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(m_path, ignored);
    }

    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const
    {
        return m_path / name;
    }

    // Writes `text` to `name`, which may have folders, and returns its path.
    std::filesystem::path write(const std::string& name, const std::string& text) const
    {
        EXPECT_TRUE(writeFile(m_path / name, text));
        return m_path / name;
    }

private:
    std::filesystem::path m_path;
};

} // namespace penumbra
