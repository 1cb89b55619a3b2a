#include "systems/physics/convex_decomposition.h"

#include "systems/physics/convex_hull.h"

#include <algorithm>
#include <numeric>

namespace penumbra {

namespace {

// Solid voxels of a mesh. A voxel is solid if the winding number at its middle is positive.
struct Grid {
    vec3 low = vec3(0); // of voxel (0, 0, 0), metres
    float cell = 0;     // metres
    ivec3 size = ivec3(0);
    std::vector<std::uint8_t> solid;

    std::size_t at(ivec3 p) const
    {
        return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(size.y) +
                static_cast<std::size_t>(p.y)) *
                   static_cast<std::size_t>(size.x) +
               static_cast<std::size_t>(p.x);
    }
};

// A part of the grid, and the hull of its solid voxels.
struct Piece {
    ivec3 low = ivec3(0), high = ivec3(0); // voxels, half open
    int voxels = 0;
    double hullVolume = 0; // m³, around the voxels' corners
};

Grid voxelise(std::span<const vec3> positions, std::span<const std::uint32_t> indices,
              int resolution)
{
    vec3 low = positions.front(), high = low;
    for (const vec3& p : positions) {
        low = min(low, p);
        high = max(high, p);
    }
    const vec3 extent = high - low;
    Grid grid;
    grid.cell = std::max({extent.x, extent.y, extent.z}) / static_cast<float>(resolution);
    // The odd shift keeps columns off vertices and edges of tidy meshes, where crossings are
    // ambiguous.
    grid.low = low - grid.cell * vec3(0.5f, 0.4871f, 0.5137f);
    grid.size = ivec3(extent / grid.cell) + 2;

    // Crossings of each column along x: where, and whether the column enters (+1) or leaves (-1).
    const std::size_t columns =
        static_cast<std::size_t>(grid.size.y) * static_cast<std::size_t>(grid.size.z);
    std::vector<std::vector<std::pair<float, int>>> crossings(columns);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const vec3 a =
            (positions[indices[i]] - grid.low) / grid.cell - 0.5f; // voxel middles at integers
        const vec3 b = (positions[indices[i + 1]] - grid.low) / grid.cell - 0.5f;
        const vec3 c = (positions[indices[i + 2]] - grid.low) / grid.cell - 0.5f;
        const float area =
            (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y); // twice, seen along x
        if (area == 0)
            continue;
        const int y0 = static_cast<int>(std::ceil(std::min({a.y, b.y, c.y})));
        const int z0 = static_cast<int>(std::ceil(std::min({a.z, b.z, c.z})));
        const int y1 = static_cast<int>(std::floor(std::max({a.y, b.y, c.y})));
        const int z1 = static_cast<int>(std::floor(std::max({a.z, b.z, c.z})));
        for (int z = z0; z <= z1; ++z) {
            for (int y = y0; y <= y1; ++y) {
                const vec2 p(static_cast<float>(y), static_cast<float>(z));
                const float v = ((p.x - a.y) * (c.z - a.z) - (p.y - a.z) * (c.y - a.y)) / area;
                const float w = ((b.y - a.y) * (p.y - a.z) - (b.z - a.z) * (p.x - a.y)) / area;
                if (v < 0 || w < 0 || v + w > 1)
                    continue;
                const std::size_t column =
                    static_cast<std::size_t>(z) * static_cast<std::size_t>(grid.size.y) +
                    static_cast<std::size_t>(y);
                crossings[column].push_back(
                    {a.x + v * (b.x - a.x) + w * (c.x - a.x), area < 0 ? 1 : -1});
            }
        }
    }

    grid.solid.resize(columns * static_cast<std::size_t>(grid.size.x));
    for (std::size_t column = 0; column < columns; ++column) {
        auto& list = crossings[column];
        std::sort(list.begin(), list.end());
        int winding = 0;
        std::size_t next = 0;
        for (int x = 0; x < grid.size.x; ++x) {
            for (; next < list.size() && list[next].first <= static_cast<float>(x); ++next)
                winding += list[next].second;
            grid.solid[column * static_cast<std::size_t>(grid.size.x) +
                       static_cast<std::size_t>(x)] = winding > 0;
        }
    }
    return grid;
}

enum class Around { Corners, Middles };

// The hull of a piece's solid voxels. The ends of its rows are all that the hull depends on. 0 when
// it is flat.
double hullVolume(const Grid& grid, ivec3 low, ivec3 high, Around around,
                  std::vector<vec3>& scratch)
{
    scratch.clear();
    for (int z = low.z; z < high.z; ++z) {
        for (int y = low.y; y < high.y; ++y) {
            int first = -1, last = -1;
            for (int x = low.x; x < high.x; ++x) {
                if (grid.solid[grid.at({x, y, z})] == 0)
                    continue;
                first = first < 0 ? x : first;
                last = x;
            }
            if (first < 0)
                continue;
            const auto add = [&](vec3 voxel) { scratch.push_back(grid.low + grid.cell * voxel); };
            const vec3 start(ivec3(first, y, z)), end(ivec3(last, y, z));
            if (around == Around::Middles) {
                add(start + 0.5f);
                add(end + 0.5f);
                continue;
            }
            for (const vec2 yz : {vec2(0, 0), vec2(0, 1), vec2(1, 0), vec2(1, 1)}) {
                add(start + vec3(0, yz));
                add(end + vec3(1, yz));
            }
        }
    }
    const Result<ConvexHull> hull = convexHull(scratch);
    return hull ? integrate(*hull).volume : 0;
}

Piece measure(const Grid& grid, ivec3 low, ivec3 high, std::vector<vec3>& scratch)
{
    Piece piece{low, high};
    for (int z = low.z; z < high.z; ++z) {
        for (int y = low.y; y < high.y; ++y) {
            for (int x = low.x; x < high.x; ++x)
                piece.voxels += grid.solid[grid.at({x, y, z})];
        }
    }
    if (piece.voxels > 0)
        piece.hullVolume = hullVolume(grid, low, high, Around::Corners, scratch);
    return piece;
}

double voxelVolume(const Grid& grid)
{
    return static_cast<double>(grid.cell) * grid.cell * grid.cell;
}

// The hull around the middles is half a voxel tighter on all sides, so the steps of the voxels do
// not count as air.
double airIn(const Grid& grid, const Piece& piece, std::vector<vec3>& scratch)
{
    const double hull = hullVolume(grid, piece.low, piece.high, Around::Middles, scratch);
    return std::max(0.0, hull - piece.voxels * voxelVolume(grid));
}

// The best of a few planes across each axis: least hull volume, and, as a cup's halves enclose as
// much as the cup, of those the plane that cuts the voxels most evenly.
bool split(const Grid& grid, const Piece& piece, std::vector<vec3>& scratch, Piece& bestLow,
           Piece& bestHigh)
{
    constexpr double kUneven = 0.15; // m³ of hull that a m³ of difference is worth
    double bestCost = 0;
    bool found = false;
    for (int axis = 0; axis < 3; ++axis) {
        const int span = piece.high[axis] - piece.low[axis];
        constexpr int kPlanes = 7;
        for (int plane = 1; plane <= kPlanes; ++plane) {
            const int offset = span * plane / (kPlanes + 1);
            if (offset == 0)
                continue;
            ivec3 lowEnd = piece.high, highStart = piece.low;
            lowEnd[axis] = highStart[axis] = piece.low[axis] + offset;
            const Piece low = measure(grid, piece.low, lowEnd, scratch);
            const Piece high = measure(grid, highStart, piece.high, scratch);
            if (low.voxels == 0 || high.voxels == 0)
                continue;
            const double cost = low.hullVolume + high.hullVolume +
                                kUneven * std::abs(low.voxels - high.voxels) * voxelVolume(grid);
            if (!found || cost < bestCost) {
                found = true;
                bestCost = cost;
                bestLow = low;
                bestHigh = high;
            }
        }
    }
    return found;
}

// Cuts away what lies beyond the plane p[axis] = limit (Sutherland and Hodgman 1974). sign +1 keeps
// what is above.
std::vector<vec3> clip(const std::vector<vec3>& polygon, int axis, float limit, float sign)
{
    std::vector<vec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const float da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
        if (da >= 0)
            kept.push_back(a);
        if ((da < 0) != (db < 0))
            kept.push_back(mix(a, b, da / (da - db)));
    }
    return kept;
}

// The mesh inside a piece: its surface cut at the piece's box, and the middles of its solid voxels.
std::vector<vec3> gather(const Grid& grid, const Piece& piece, std::span<const vec3> positions,
                         std::span<const std::uint32_t> indices)
{
    const vec3 low = grid.low + grid.cell * vec3(piece.low),
               high = grid.low + grid.cell * vec3(piece.high);
    std::vector<vec3> points;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::vector<vec3> polygon{positions[indices[i]], positions[indices[i + 1]],
                                  positions[indices[i + 2]]};
        for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
            polygon = clip(polygon, axis, low[axis], 1);
            polygon = clip(polygon, axis, high[axis], -1);
        }
        points.insert(points.end(), polygon.begin(), polygon.end());
    }
    for (int z = piece.low.z; z < piece.high.z; ++z) {
        for (int y = piece.low.y; y < piece.high.y; ++y) {
            for (int x = piece.low.x; x < piece.high.x; ++x) {
                if (grid.solid[grid.at({x, y, z})] != 0)
                    points.push_back(grid.low + grid.cell * (vec3(ivec3(x, y, z)) + 0.5f));
            }
        }
    }
    return points;
}

std::string findFault(std::span<const vec3> positions, std::span<const std::uint32_t> indices,
                      const DecompositionOptions& options)
{
    if (options.maxPieces < 1 || options.maxPieces > 256 || options.resolution < 8 ||
        options.resolution > 128 || !(options.concavity >= 0 && options.concavity <= 1))
        return fmt::format("{} pieces in [1, 256], resolution {} in [8, 128], concavity {} in [0, "
                           "1]: out of range",
                           options.maxPieces, options.resolution, options.concavity);
    if (indices.empty() || indices.size() % 3 != 0)
        return fmt::format("{} indices are no list of triangles", indices.size());
    for (const std::uint32_t index : indices) {
        if (index >= positions.size())
            return fmt::format("index {} of {} vertices", index, positions.size());
    }
    const Result<ConvexHull> hull = convexHull(positions);
    return hull ? std::string() : hull.error().message;
}

} // namespace

Result<std::vector<std::vector<vec3>>> decompose(std::span<const vec3> positions,
                                                 std::span<const std::uint32_t> indices,
                                                 const DecompositionOptions& options)
{
    const std::string fault = findFault(positions, indices, options);
    if (!fault.empty())
        return Error{"decompose: " + fault};
    const Grid grid = voxelise(positions, indices, options.resolution);
    std::vector<vec3> scratch;
    std::vector<Piece> pieces{measure(grid, ivec3(0), grid.size, scratch)};
    if (pieces[0].voxels == 0)
        return Error{
            "decompose: the mesh encloses nothing; close it, or turn its triangles outwards"};

    const double enough = options.concavity * pieces[0].hullVolume;
    std::vector<double> air{airIn(grid, pieces[0], scratch)}; // per piece
    while (static_cast<int>(pieces.size()) < options.maxPieces) {
        const auto worst =
            static_cast<std::size_t>(std::max_element(air.begin(), air.end()) - air.begin());
        Piece low, high;
        if (std::accumulate(air.begin(), air.end(), 0.0) <= enough ||
            !split(grid, pieces[worst], scratch, low, high))
            break;
        pieces[worst] = low;
        air[worst] = airIn(grid, low, scratch);
        pieces.push_back(high);
        air.push_back(airIn(grid, high, scratch));
    }

    std::vector<std::vector<vec3>> result;
    for (const Piece& piece : pieces) {
        // A sliver that is flat within one voxel adds nothing that its neighbours lack.
        if (const Result<ConvexHull> hull = convexHull(gather(grid, piece, positions, indices)))
            result.push_back(hull->points);
    }
    return result;
}

} // namespace penumbra
