#include "runtime/vk/instance.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <mutex>

namespace penumbra {

struct ValidationLog {
    std::mutex mutex;
    std::uint64_t count = 0;
    std::vector<std::string> messages;
    bool echo = false;
};

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::size_t kKeptMessages = 256; // a broken frame repeats itself; the first ones say why

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data,
                                         void* userData)
{
    ValidationLog& log = *static_cast<ValidationLog*>(userData);
    const std::lock_guard lock(log.mutex);
    ++log.count;
    if (log.messages.size() < kKeptMessages)
        log.messages.emplace_back(data->pMessage);
    if (log.echo)
        fmt::print(stderr, "vulkan: {}\n", data->pMessage);
    return VK_FALSE;
}

// Validation messages only: the loader's own remarks about manifests are no fault of ours.
VkDebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog& log)
{
    VkDebugUtilsMessengerCreateInfoEXT info = {};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = &log;
    return info;
}

std::vector<VkExtensionProperties> instanceExtensions(const char* layer)
{
    std::uint32_t count = 0;
    if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS)
        return {}; // no driver, or no such layer; vkCreateInstance says which
    std::vector<VkExtensionProperties> extensions(count);
    vkCheck(vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data()),
            "list instance extensions");
    return extensions;
}

bool contains(const std::vector<VkExtensionProperties>& extensions, const char* name)
{
    return std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& e) {
        return std::strcmp(e.extensionName, name) == 0;
    });
}

// Without a driver the loader still lists extensions of its own and of layers.
bool hasDriver()
{
    const VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    VkInstance instance = VK_NULL_HANDLE;
    if (vkCreateInstance(&info, nullptr, &instance) != VK_SUCCESS)
        return false;
    vkDestroyInstance(instance, nullptr);
    return true;
}

bool hasValidationLayer()
{
    std::uint32_t count = 0;
    vkCheck(vkEnumerateInstanceLayerProperties(&count, nullptr), "count layers");
    std::vector<VkLayerProperties> layers(count);
    vkCheck(vkEnumerateInstanceLayerProperties(&count, layers.data()), "list layers");
    return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, kValidationLayer) == 0;
    });
}

template <class Function>
Function instanceFunction(VkInstance instance, const char* name)
{
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

} // namespace

Error noDeviceError()
{
    return {
        "no Vulkan device: this machine has no Vulkan driver, or VK_DRIVER_FILES / "
        "VK_ICD_FILENAMES hides it; install one (Debian: apt install mesa-vulkan-drivers, which "
        "has a software device too)"};
}

Result<Instance> createInstance(const InstanceOptions& options)
{
    const std::vector<VkExtensionProperties> available = instanceExtensions(nullptr);
    std::vector<const char*> extensions;
    for (const std::string& name : options.extensions) {
        if (!contains(available, name.c_str()))
            return !hasDriver()
                       ? noDeviceError()
                       : Error{fmt::format("the Vulkan driver lacks the instance extension "
                                           "{}; update it, or run without a window",
                                           name)};
        extensions.push_back(name.c_str());
    }

    const bool validation = options.validation || options.gpuAssistedValidation;
    if (validation && !hasValidationLayer())
        return Error{fmt::format("{} is not installed (Debian: apt install "
                                 "vulkan-validationlayers); or run without validation",
                                 kValidationLayer)};
    // The layer brings the extension too, where the driver does not.
    const bool debugUtils = validation || contains(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (debugUtils)
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validation)
        extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

    auto log = std::make_unique<ValidationLog>();
    log->echo = options.echoMessages;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(*log);

    std::vector<VkValidationFeatureEnableEXT> checks = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    if (options.gpuAssistedValidation) {
        checks.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT);
        checks.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT);
    }
    VkValidationFeaturesEXT features = {VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.pNext = &messenger; // messages of vkCreateInstance itself
    features.enabledValidationFeatureCount = static_cast<std::uint32_t>(checks.size());
    features.pEnabledValidationFeatures = checks.data();

    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = options.applicationName.c_str();
    application.pEngineName = "penumbra";
    application.apiVersion = VK_API_VERSION_1_3;

    VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pNext = validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = validation ? 1 : 0;
    info.ppEnabledLayerNames = &kValidationLayer;
    info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();

    VkInstance handle = VK_NULL_HANDLE;
    const VkResult created = vkCreateInstance(&info, nullptr, &handle);
    if (created == VK_ERROR_INCOMPATIBLE_DRIVER) // the loader's answer when it finds no driver
        return noDeviceError();
    if (Result<void> ok = vkTry(created, "create a Vulkan instance"); !ok)
        return ok.error();

    VkDebugUtilsMessengerEXT messengerHandle = VK_NULL_HANDLE;
    if (validation) {
        const auto create = instanceFunction<PFN_vkCreateDebugUtilsMessengerEXT>(
            handle, "vkCreateDebugUtilsMessengerEXT");
        vkCheck(create(handle, &messenger, nullptr, &messengerHandle), "listen to validation");
    }
    return Instance(handle, messengerHandle, std::move(log), debugUtils);
}

Instance::Instance(VkInstance instance, VkDebugUtilsMessengerEXT messenger,
                   std::unique_ptr<ValidationLog> log, bool hasDebugUtils)
    : handle(instance), debugUtils(hasDebugUtils), m_messenger(messenger), m_log(std::move(log))
{}

Instance::Instance(Instance&& other) noexcept
    : handle(std::exchange(other.handle, VK_NULL_HANDLE)), debugUtils(other.debugUtils),
      m_messenger(other.m_messenger), m_log(std::move(other.m_log))
{}

Instance::~Instance()
{
    if (handle == VK_NULL_HANDLE)
        return;
    if (m_messenger != VK_NULL_HANDLE)
        instanceFunction<PFN_vkDestroyDebugUtilsMessengerEXT>(
            handle, "vkDestroyDebugUtilsMessengerEXT")(handle, m_messenger, nullptr);
    vkDestroyInstance(handle, nullptr);
}

std::uint64_t Instance::validationCount() const
{
    const std::lock_guard lock(m_log->mutex);
    return m_log->count;
}

std::vector<std::string> Instance::validationMessages() const
{
    const std::lock_guard lock(m_log->mutex);
    return m_log->messages;
}

void Instance::clearValidationMessages()
{
    const std::lock_guard lock(m_log->mutex);
    m_log->count = 0;
    m_log->messages.clear();
}

} // namespace penumbra
