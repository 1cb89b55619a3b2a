#include "assets/draco_decoder.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <optional>

namespace penumbra {

namespace {

constexpr std::array<std::uint8_t, 7> kTriangleMesh22 = {'D', 'R', 'A', 'C', 'O', 2, 2};

// Reads on zeros after the end; `cut` says so.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : m_bytes(bytes) {}

    std::uint8_t byte()
    {
        cut = cut || m_bytes.empty();
        if (cut)
            return 0;
        const auto value = std::to_integer<std::uint8_t>(m_bytes.front());
        m_bytes = m_bytes.subspan(1);
        return value;
    }

    // LEB128, as draco/core/varint_decoding.h.
    std::uint64_t varint()
    {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            const std::uint64_t part = byte();
            value |= (part & 0x7f) << shift;
            if ((part & 0x80) == 0)
                return value;
        }
        cut = true;
        return 0;
    }

    bool cut = false;

private:
    std::span<const std::byte> m_bytes;
};

Error tooMuch(std::uint64_t bytes)
{
    return {fmt::format("Draco mesh that takes {} MiB of memory to decode, above the limit of {}; "
                        "simplify it, or export fewer attributes",
                        bytes >> 20, kMaxDracoBytes >> 20)};
}

Error aboveLimits(std::uint64_t vertices, std::uint64_t triangles, const DracoLimits& limits)
{
    return {fmt::format("Draco mesh of {} vertices and {} triangles, above the limits of {} and {} "
                        "that its accessors or the format set",
                        vertices, triangles, limits.vertices, limits.triangles)};
}

struct Head {
    bool sequential = true;
    std::uint64_t connectivityBytes = 0; // memory, see kDracoTriangleBytes
};

// "DRACO", major, minor, geometry type (1 = triangles), method (0 sequential, 1 edgebreaker),
// flags[2]; then, unless metadata comes between: sequential: triangles, vertices; edgebreaker:
// traversal[1], vertices, triangles, attributes with seams[1], symbols, split symbols.
Result<Head> readHead(std::span<const std::byte> bytes, const DracoLimits& limits)
{
    constexpr std::size_t kHeaderBytes = kTriangleMesh22.size() + 4;
    if (bytes.size() < kHeaderBytes || std::memcmp(bytes.data(), "DRACO", 5) != 0)
        return Error{"not a Draco payload"};
    if (std::memcmp(bytes.data(), kTriangleMesh22.data(), kTriangleMesh22.size()) != 0)
        return Error{"a Draco bitstream other than 2.2; re-export with a current exporter"};
    const auto type = std::to_integer<int>(bytes[7]);
    const auto method = std::to_integer<int>(bytes[8]);
    if (type != 1 || method > 1)
        return Error{"Draco geometry that is not a triangle mesh"};
    if ((std::to_integer<int>(bytes[10]) & 0x80) != 0)
        return Error{"Draco metadata, which glTF does not use; re-export without it"};

    ByteReader reader(bytes.subspan(kHeaderBytes));
    Head head{.sequential = method == 0};
    std::uint64_t vertices = 0, triangles = 0, seams = 0, splits = 0;
    if (head.sequential) {
        triangles = reader.varint();
        vertices = reader.varint();
    } else {
        reader.byte();
        vertices = reader.varint();
        triangles = reader.varint();
        seams = reader.byte();
        reader.varint();
        splits = reader.varint();
    }
    if (reader.cut)
        return Error{"Draco payload cut off"};
    if (vertices > limits.vertices || triangles > limits.triangles)
        return aboveLimits(vertices, triangles, limits);
    if (splits > triangles) // each is a triangle's; libdraco takes memory for them as for vertices
        return Error{fmt::format("Draco mesh with {} splits of {} triangles", splits, triangles)};
    head.connectivityBytes = triangles * (kDracoTriangleBytes + seams * kDracoSeamBytes);
    if (head.connectivityBytes > kMaxDracoBytes)
        return tooMuch(head.connectivityBytes);
    return head;
}

// Memory for the attributes of one vertex, from their descriptions: decoders[1]; for edgebreaker 3
// bytes for each decoder; for each decoder the number of its attributes, for each of them type[1],
// data type[1], components[1], normalised[1] and id, then its method[1].
std::uint64_t vertexBytes(std::span<const std::byte> descriptions, bool sequential)
{
    ByteReader reader(descriptions);
    std::uint64_t sum = 0;
    const unsigned decoders = reader.byte();
    for (unsigned i = 0; i < decoders && !sequential; ++i)
        for (int k = 0; k < 3; ++k)
            reader.byte();
    for (unsigned i = 0; i < decoders; ++i) {
        const std::uint64_t attributes = reader.varint();
        // A number without its descriptions counts too: libdraco makes room for it.
        sum += attributes * kDracoAttributeBytes;
        if (sum > kMaxDracoBytes)
            return sum;
        for (std::uint64_t a = 0; a < attributes && !reader.cut; ++a) {
            reader.byte();
            const int size = draco::DataTypeLength(static_cast<draco::DataType>(reader.byte()));
            sum += reader.byte() * (4 + static_cast<std::uint64_t>(std::max(size, 0)));
            reader.byte();
            reader.varint();
        }
        for (std::uint64_t a = 0; a < attributes && !reader.cut; ++a)
            reader.byte();
    }
    return sum;
}

// A decoder that stops between connectivity and attributes to add up what the latter take.
template <class Decoder>
class BoundedDecoder final : public Decoder {
public:
    BoundedDecoder(const DracoLimits& limits, const Head& head) : m_limits(limits), m_head(head) {}

    std::optional<Error> refusal;

protected:
    bool DecodePointAttributes() override
    {
        const std::uint64_t vertices = this->point_cloud()->num_points();
        if (vertices > m_limits.vertices) { // edgebreaker adds some at seams
            refusal = aboveLimits(vertices, this->mesh()->num_faces(), m_limits);
            return false;
        }
        const draco::DecoderBuffer& rest = *this->buffer();
        const std::uint64_t memory =
            m_head.connectivityBytes +
            std::max<std::uint64_t>(vertices, 1) *
                vertexBytes({reinterpret_cast<const std::byte*>(rest.data_head()),
                             static_cast<std::size_t>(rest.remaining_size())},
                            m_head.sequential);
        if (memory > kMaxDracoBytes) {
            refusal = tooMuch(memory);
            return false;
        }
        return Decoder::DecodePointAttributes();
    }

private:
    DracoLimits m_limits;
    Head m_head;
};

template <class Decoder>
Result<std::unique_ptr<draco::Mesh>> decodeBy(std::span<const std::byte> bytes,
                                              const DracoLimits& limits, const Head& head)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto mesh = std::make_unique<draco::Mesh>();
    BoundedDecoder<Decoder> decoder(limits, head);
    const draco::Status status = decoder.Decode(draco::DecoderOptions(), &buffer, mesh.get());
    if (decoder.refusal)
        return *decoder.refusal;
    if (!status.ok())
        return Error{"Draco: " + status.error_msg_string()};
    return mesh;
}

} // namespace

Result<std::unique_ptr<draco::Mesh>> decodeDracoMesh(std::span<const std::byte> bytes,
                                                     const DracoLimits& limits)
{
    const Result<Head> head = readHead(bytes, limits);
    if (!head)
        return head.error();
    try {
        auto decoded = head->sequential
                           ? decodeBy<draco::MeshSequentialDecoder>(bytes, limits, *head)
                           : decodeBy<draco::MeshEdgebreakerDecoder>(bytes, limits, *head);
        if (!decoded)
            return decoded;
        const draco::Mesh& mesh = **decoded;
        for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
            for (const draco::PointIndex& corner : mesh.face(f))
                if (corner.value() >= mesh.num_points())
                    return Error{fmt::format("Draco triangle {} uses vertex {} of {}", f.value(),
                                             corner.value(), mesh.num_points())};
        return decoded;
    } catch (const std::exception& exception) {
        return Error{fmt::format("Draco: {}", exception.what())};
    }
}

} // namespace penumbra
