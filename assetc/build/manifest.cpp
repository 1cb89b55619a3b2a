#include "assetc/build/manifest.h"

#include "assetc/file_type.h"
#include "runtime/file.h"

#include <algorithm>
#include <map>

namespace penumbra {

namespace {

constexpr std::uint64_t kManifestVersion = 1;
constexpr std::size_t kMaxManifestBytes = 64u << 20;
constexpr std::size_t kMaxAssets = 100'000;
constexpr std::size_t kMaxNameLength = 200; // a file name has 255 bytes at most

bool hasControl(const std::string& text)
{
    return std::any_of(text.begin(), text.end(),
                       [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

// Outputs stay in the folder and out of ".penumbra": no part of a name starts with a dot.
bool isPlainName(const std::string& name)
{
    if (name.empty() || name.size() > kMaxNameLength || hasControl(name) ||
        name.find('\\') != std::string::npos)
        return false;
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        if (end == begin || name[begin] == '.')
            return false;
        begin = end + 1;
    }
    return true;
}

std::string kindNames()
{
    std::string names;
    for (const AssetKind& kind : assetKinds())
        names += (names.empty() ? "" : ", ") + std::string(kind.name);
    return names;
}

std::string sourceEndings()
{
    std::string endings;
    for (const AssetKind& kind : assetKinds())
        for (const char* ending : kind.sourceEndings)
            endings += (endings.empty() ? "" : ", ") + std::string(ending);
    return endings;
}

// Why a file can be no source at all, told by its beginning. Empty where it can.
std::string wrongSource(const std::filesystem::path& source)
{
    constexpr std::uint64_t kHeadBytes = 64u << 10;
    const auto head = readFileHead(source, kHeadBytes);
    if (!head)
        return "cannot be used: " + head.error().message;
    const RecognisedFile file = recogniseHead(head->bytes, source);
    return file.type == FileType::Other || file.type == FileType::Environment
               ? "is " + fileTypeText(file)
               : std::string();
}

const AssetKind* readKind(const JsonReader& asset, const std::filesystem::path& source)
{
    const std::span<const AssetKind> kinds = assetKinds();
    if (asset.has("kind")) {
        const std::string name = asset.text("kind");
        for (const AssetKind& kind : kinds)
            if (kind.name == name)
                return &kind;
        asset.member("kind").refuse(
            fmt::format("is {}, known are {}", asset.member("kind").quoted(), kindNames()));
        return nullptr;
    }
    std::string ending = source.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const AssetKind& kind : kinds)
        if (std::find(kind.sourceEndings.begin(), kind.sourceEndings.end(), ending) !=
            kind.sourceEndings.end())
            return &kind;
    if (const std::string wrong = wrongSource(source); !wrong.empty())
        asset.member("source").refuse(wrong);
    else
        asset.member("source").refuse(
            fmt::format("is {}, whose ending is none of {}; give the asset a \"kind\"",
                        asset.member("source").quoted(), sourceEndings()));
    return nullptr;
}

// The object `key` of `object`, where there is one.
nlohmann::json objectAt(const nlohmann::json& object, const char* key)
{
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found != object.end() && found->is_object() ? *found : nlohmann::json::object();
}

// `value` is what `asset` reads.
ManifestAsset readAsset(const JsonReader& asset, const nlohmann::json& value,
                        const std::filesystem::path& folder, const nlohmann::json& defaults)
{
    ManifestAsset result;
    asset.refuseOthers({"name", "source", "kind", "options"});
    if (!value.is_object())
        return result;
    result.name = asset.text("name");
    if (asset.has("name") && !isPlainName(result.name))
        asset.member("name").refuse(
            fmt::format("is \"{}\", not a plain path inside the output folder: 1 to {} bytes, no "
                        "\"..\", no \"/\" at an end, no part that starts with a dot",
                        result.name.substr(0, kMaxNameLength), kMaxNameLength));
    const std::string source = asset.text("source");
    if (!asset.has("source"))
        return result;
    if (source.empty() || hasControl(source)) {
        asset.member("source").refuse("is not the path of a file");
        return result;
    }
    result.source = folder / source;
    result.kind = readKind(asset, result.source);
    if (!result.kind)
        return result;
    result.options = objectAt(defaults, result.kind->name);
    if (asset.has("options")) {
        result.kind->checkOptions(asset.member("options"));
        result.options.update(objectAt(value, "options"));
    }
    return result;
}

void checkDefaults(const JsonReader& defaults, const nlohmann::json& value)
{
    const std::span<const AssetKind> kinds = assetKinds();
    if (!value.is_object()) {
        defaults.refuse("is not an object");
        return;
    }
    for (const auto& [key, options] : value.items()) {
        const auto kind =
            std::find_if(kinds.begin(), kinds.end(),
                         [&name = key](const AssetKind& k) { return k.name == name; });
        if (kind == kinds.end())
            defaults.refuse(
                fmt::format("has no member \"{}\"; known: {}", key.substr(0, 60), kindNames()));
        else
            kind->checkOptions(defaults.member(kind->name));
    }
}

// Nothing else lies in the folder of an asset that has one: what its parts are called is not known
// before it is compiled.
void refuseSharedFolders(const Manifest& manifest, const JsonReader& assets,
                         const std::map<std::string, std::size_t>& firstOf)
{
    for (std::size_t i = 0; i < manifest.assets.size(); ++i) {
        const std::string& name = manifest.assets[i].name;
        for (std::size_t end = name.find('/'); end != std::string::npos;
             end = name.find('/', end + 1)) {
            const auto above = firstOf.find(name.substr(0, end));
            if (above == firstOf.end())
                continue;
            const ManifestAsset& owner = manifest.assets[above->second];
            if (owner.kind && owner.kind->hasFolder())
                assets.element(i).member("name").refuse(
                    fmt::format("lies in the folder of the {} {}; choose another name",
                                owner.kind->name, owner.place));
        }
    }
}

// Of the assets whose kind is known; of the others it is said already.
void refuseMissingSources(const Manifest& manifest, const JsonReader& assets)
{
    for (std::size_t i = 0; i < manifest.assets.size(); ++i) {
        const ManifestAsset& asset = manifest.assets[i];
        if (!asset.kind)
            continue;
        if (const auto head = readFileHead(asset.source, 0); !head)
            assets.element(i).member("source").refuse("cannot be used: " + head.error().message);
    }
}

} // namespace

std::optional<Manifest> readManifest(const std::filesystem::path& file, JsonProblems& problems,
                                     ManifestSources sources)
{
    const auto bytes = readInput(file, FileType::Manifest, kMaxManifestBytes);
    if (!bytes) { // its message names the file
        problems.push_back(bytes.error());
        return std::nullopt;
    }
    const auto document =
        parseJson({reinterpret_cast<const char*>(bytes->data()), bytes->size()}, kMaxManifestBytes);
    if (!document) {
        problems.push_back(fail(document.error(), file.string()));
        return std::nullopt;
    }
    JsonProblems found;
    const JsonReader root(*document, "", found);
    Manifest manifest;
    manifest.file = file;
    root.refuseOthers({"version", "defaults", "assets"});
    root.checkVersion(kManifestVersion);
    if (root.has("defaults"))
        checkDefaults(root.member("defaults"), (*document)["defaults"]);
    const nlohmann::json defaults = objectAt(*document, "defaults");
    const JsonReader assets = root.member("assets");
    const std::size_t count = assets.length(kMaxAssets);
    std::map<std::string, std::size_t> firstOf;
    for (std::size_t i = 0; i < count; ++i) {
        const JsonReader reader = assets.element(i);
        ManifestAsset asset =
            readAsset(reader, (*document)["assets"][i], file.parent_path(), defaults);
        asset.place = fmt::format("assets[{}]", i);
        const auto [first, isNew] = firstOf.emplace(asset.name, i);
        if (!isNew && !asset.name.empty())
            reader.member("name").refuse(fmt::format("is \"{}\", as is the name of assets[{}]",
                                                     asset.name.substr(0, kMaxNameLength),
                                                     first->second));
        manifest.assets.push_back(std::move(asset));
    }
    refuseSharedFolders(manifest, assets, firstOf);
    if (sources == ManifestSources::Checked || !found.empty())
        refuseMissingSources(manifest, assets);
    for (const Error& problem : found)
        problems.push_back(fail(problem, file.string()));
    if (!found.empty())
        return std::nullopt;
    return manifest;
}

} // namespace penumbra
