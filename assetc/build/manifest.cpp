#include "assetc/build/manifest.h"

#include "assetc/build/depfile.h"
#include "assetc/json_input.h"
#include "assetc/option_rules.h"
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
        const JsonReader stated = asset.member("kind");
        const std::string name = stated.asText();
        for (const AssetKind& kind : kinds)
            if (kind.name == name)
                return &kind;
        if (stated.isText())
            stated.refuse(fmt::format("is {}, known: {}", stated.quoted(), kindNames()));
        return nullptr;
    }
    const std::string ending = endingOf(source);
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

// `defaults` with the members of `own` over them; null stands for the compiler's own default.
nlohmann::json merged(nlohmann::json defaults, const nlohmann::json& own)
{
    defaults.update(own);
    for (auto i = defaults.begin(); i != defaults.end();)
        i = i->is_null() ? defaults.erase(i) : std::next(i);
    return defaults;
}

// Of `options`, into which `own` went: a conflict of the defaults alone is said there.
void refuseConflicts(const JsonReader& place, const nlohmann::json& options,
                     const nlohmann::json& own)
{
    const auto has = [](const nlohmann::json& object, const OptionRule& rule) {
        const auto found = object.find(rule.member);
        return found != object.end() && !found->is_null() &&
               (rule.value != OptionRule::Value::Flag || *found == false);
    };
    for (const OptionConflict& conflict : optionConflicts())
        if (has(options, *conflict.option) && has(options, *conflict.other) &&
            (has(own, *conflict.option) || has(own, *conflict.other)))
            place.refuse(fmt::format("has {}, or set it to null where it is a default",
                                     conflictText(conflict, &OptionRule::member)));
}

// `value` is what `asset` reads.
ManifestAsset readAsset(const JsonReader& asset, const nlohmann::json& value,
                        const std::filesystem::path& folder, const nlohmann::json& defaults)
{
    ManifestAsset result;
    asset.refuseOthers({"name", "source", "kind", "options"});
    if (!value.is_object())
        return result;
    const JsonReader name = asset.member("name");
    result.name = name.asText();
    if (name.isText() && !isPlainName(result.name))
        name.refuse(
            fmt::format("is {}, not a plain path inside the output folder: 1 to {} bytes, no "
                        "\"..\", no \"/\" at an end, no part that starts with a dot",
                        name.quoted(), kMaxNameLength));
    const JsonReader sourceName = asset.member("source");
    const std::string source = sourceName.asText();
    if (!sourceName.isText())
        return result;
    if (source.empty() || hasControl(source)) {
        sourceName.refuse("is not the path of a file");
        return result;
    }
    result.source = folder / source;
    result.kind = readKind(asset, result.source);
    if (!result.kind)
        return result;
    const nlohmann::json own = objectAt(value, "options");
    result.options = merged(objectAt(defaults, result.kind->name), own);
    if (asset.has("options")) {
        result.kind->checkOptions(asset.member("options"));
        refuseConflicts(asset.member("options"), result.options, own);
    }
    return result;
}

void checkDefaults(const JsonReader& defaults, const nlohmann::json& value)
{
    const std::span<const AssetKind> kinds = assetKinds();
    std::vector<std::string_view> names;
    for (const AssetKind& kind : kinds)
        names.emplace_back(kind.name);
    defaults.refuseOthers(names);
    for (const AssetKind& kind : kinds)
        if (defaults.has(kind.name)) {
            kind.checkOptions(defaults.member(kind.name));
            const nlohmann::json options = objectAt(value, kind.name);
            refuseConflicts(defaults.member(kind.name), options, options);
        }
}

// No output lies in a folder that is another's: the folder of a scene, whose parts have names that
// are not known before it is compiled, or what is a file.
void refuseSharedPlaces(const Manifest& manifest, const JsonReader& assets)
{
    std::map<std::string, std::size_t> ownerOf; // of files, and of folders that are an asset's own
    const auto refuse = [&](std::size_t i, const std::string& place, std::size_t owner) {
        const ManifestAsset& other = manifest.assets[owner];
        if (other.name != manifest.assets[i].name) // else it is said already
            assets.element(i).member("name").refuse(
                other.kind->hasFolder()
                    ? fmt::format("lies in the folder of the {} {}; choose another name",
                                  other.kind->name, other.place)
                    : fmt::format("makes \"{}\" a folder, which is a file of {}; choose another "
                                  "name",
                                  place, other.place));
    };
    const auto own = [&](std::size_t i, const std::string& place) {
        if (const auto [first, isNew] = ownerOf.emplace(place, i); !isNew)
            refuse(i, place, first->second);
    };
    for (std::size_t i = 0; i < manifest.assets.size(); ++i) {
        const ManifestAsset& asset = manifest.assets[i];
        if (!asset.kind || asset.name.empty())
            continue;
        if (asset.kind->hasFolder()) {
            own(i, asset.name);
        } else {
            own(i, asset.outputName());
            own(i, asset.outputName() + kDepfileEnding);
        }
    }
    for (std::size_t i = 0; i < manifest.assets.size(); ++i) {
        const std::string& name = manifest.assets[i].name;
        for (std::size_t end = name.find('/'); end != std::string::npos;
             end = name.find('/', end + 1))
            if (const auto above = ownerOf.find(name.substr(0, end)); above != ownerOf.end())
                refuse(i, above->first, above->second);
    }
}

// Of the assets whose kind is known; of the others it is said already.
void refuseWrongSources(const Manifest& manifest, const JsonReader& assets)
{
    for (std::size_t i = 0; i < manifest.assets.size(); ++i) {
        const ManifestAsset& asset = manifest.assets[i];
        if (!asset.kind)
            continue;
        if (const auto head = readFileHead(asset.source, 0); !head)
            assets.element(i).member("source").refuse("cannot be used: " + head.error().message);
        else if (const std::string wrong = wrongKind(*asset.kind, asset.source); !wrong.empty())
            assets.element(i).member("source").refuse(wrong);
    }
}

} // namespace

std::optional<Manifest> readManifest(const std::filesystem::path& file, JsonProblems& problems,
                                     ManifestSources sources)
{
    const auto read = [&](const nlohmann::json& document, JsonProblems& found) {
        const JsonReader root(document, "", found);
        Manifest manifest;
        manifest.file = file;
        root.refuseOthers({"version", "defaults", "assets"});
        root.checkVersion(kManifestVersion);
        if (root.has("defaults"))
            checkDefaults(root.member("defaults"), document["defaults"]);
        const nlohmann::json defaults = objectAt(document, "defaults");
        const JsonReader assets = root.member("assets");
        const std::size_t count = assets.length(kMaxAssets);
        std::map<std::string, std::size_t> firstOf;
        for (std::size_t i = 0; i < count; ++i) {
            const JsonReader reader = assets.element(i);
            ManifestAsset asset =
                readAsset(reader, document["assets"][i], file.parent_path(), defaults);
            asset.place = fmt::format("assets[{}]", i);
            const auto [first, isNew] = firstOf.emplace(asset.name, i);
            if (!isNew && !asset.name.empty())
                reader.member("name").refuse(fmt::format("is {}, as is the name of assets[{}]",
                                                         reader.member("name").quoted(),
                                                         first->second));
            manifest.assets.push_back(std::move(asset));
        }
        refuseSharedPlaces(manifest, assets);
        if (sources == ManifestSources::Checked || !found.empty())
            refuseWrongSources(manifest, assets);
        return manifest;
    };
    return readJsonInput<Manifest>(file, FileType::Manifest, kMaxManifestBytes, problems, read);
}

} // namespace penumbra
