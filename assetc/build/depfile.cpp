#include "assetc/build/depfile.h"

namespace penumbra {

namespace {

std::string escaped(const std::string& name)
{
    std::string text;
    std::size_t backslashes = 0; // just before c; make halves them before what is escaped
    for (const char c : name) {
        if (c == '$')
            text += '$';
        else if (c == ' ' || c == '\t' || c == '#' || c == ':')
            text.append(backslashes + 1, '\\');
        text += c;
        backslashes = c == '\\' ? backslashes + 1 : 0;
    }
    return text;
}

} // namespace

Result<std::string> depfileText(const std::filesystem::path& output,
                                const std::vector<std::filesystem::path>& files)
{
    std::string text = escaped(output.string()) + ":";
    for (const std::filesystem::path& file : files)
        text += " \\\n  " + escaped(file.string());
    std::size_t lines = 0;
    for (const char c : text)
        lines += c == '\n';
    if (lines != files.size())
        return Error{"a file name with a line feed, which no depfile can hold; rename it"};
    return text + "\n";
}

} // namespace penumbra
