#version 460
// pixel_clusters: one workgroup per block of pixels, one invocation per quad. The receivers of each instance in the block,
// in Morton order, become clusters of 64, as the vertices of a mesh are: what entity_sort and combine need not tell apart.
//   reads   geometryImage, selfVisibilityImage, instanceImage
//   writes  receivers, clusters, counts [clusters], slots [pixel], cull.sortGroups, cull.combineGroups
// Receivers stay in object space, so a pixel at a vertex is that vertex. Which number a cluster gets depends on arrival;
// what is in it does not, and nothing depends on the number. Lanes of a cluster beyond its count keep what they held:
// combine works on them, nobody reads the result.
// Clusters beyond push.capacity are left out, and counted in cull.dropped: pixel_resolve fills their pixels from others.
#extension GL_GOOGLE_include_directive : require
#include "shaders/pixel.glsl"

layout(local_size_x = kPixelQuads) in;

const uint kWords = kPixelQuads * 4u / 32u;
shared uint members[kWords]; // of the chosen instance, a bit per pixel of the block
shared uint before[kWords];  // members in the words before
shared uint chosen, total, firstCluster;

// At rate 2: no two samples on opposite sides of pixel k may stand for it. One side alone would draw its light on over an
// edge, which at a flat angle is far.
bool standsAlone(uint k)
{
    const bool between = likeness(k, 0u) > 0.0 && likeness(k, k) > 0.0;
    return !(k == 3u && likeness(k, 1u) > 0.0 && likeness(k, 2u) > 0.0) && !between;
}

void main()
{
    const uint quad = gl_LocalInvocationIndex, word = quad / 8u, shift = 4u * (quad % 8u);
    const ivec2 corner = ivec2(gl_WorkGroupID.xy * kPixelBlock + 2u * quadPlace(quad));
    uint instance[4], slot[4];
    loadQuad(corner);
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        slot[k] = kNoSlot;
        instance[k] = kRate == 1u || k == 0u || standsAlone(k) ? quadInstance[k] : kBackground;
    }

    while (true) { // an instance per round, smallest index first
        barrier();
        if (quad == 0u)
            chosen = kBackground;
        if (quad < kWords)
            members[quad] = 0u;
        barrier();
        const uint smallest = min(min(instance[0], instance[1]), min(instance[2], instance[3]));
        if (smallest != kBackground)
            atomicMin(chosen, smallest);
        barrier();
        const uint current = chosen;
        if (current == kBackground)
            break;
        uint own = 0u;
        [[unroll]] for (uint k = 0u; k < 4u; ++k)
            own |= instance[k] == current ? 1u << k : 0u;
        if (own != 0u)
            atomicOr(members[word], own << shift);
        barrier();
        if (quad < kWords) {
            uint sum = 0u;
            for (uint i = 0u; i < quad; ++i)
                sum += bitCount(members[i]);
            before[quad] = sum;
            if (quad == kWords - 1u) {
                total = sum + bitCount(members[quad]);
                const uint made = (total + kClusterReceivers - 1u) / kClusterReceivers;
                firstCluster = atomicAdd(cull.combineGroups[0], made); // pixel_bounds cuts it to the capacity
                const uint end = min(firstCluster + made, push.capacity);
                atomicMax(cull.sortGroups[0], (end + kSortGroup - 1u) / kSortGroup);
                if (end < firstCluster + made)
                    atomicAdd(cull.dropped, min(firstCluster + made - end, made));
            }
        }
        barrier();
        const uint mine = firstCluster + quad;
        if (quad * kClusterReceivers < total && mine < push.capacity) {
            clusters[mine] = SceneCluster(current, mine, mine * kClusterReceivers, mine * kClusterReceivers);
            counts[mine] = min(total - quad * kClusterReceivers, kClusterReceivers);
        }
        uint at = firstCluster * kClusterReceivers + before[word] + bitCount(members[word] & ((1u << shift) - 1u));
        [[unroll]] for (uint k = 0u; k < 4u; ++k)
            if (instance[k] == current) {
                slot[k] = at < push.capacity * kClusterReceivers ? at : kNoSlot;
                instance[k] = kBackground;
                ++at;
            }
    }

    uint filled = 0u;
    [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        const ivec2 pixel = quadPixel(corner, k);
        filled |= slot[k] != kNoSlot ? 1u << k : 0u;
        if (inside(pixel))
            slots[pixelIndex(pixel)] = slot[k];
    }
    for (; filled != 0u; filled &= filled - 1u) { // a loop: lavapipe runs branches that no lane takes
        const uint k = uint(findLSB(filled));
        const uint at = k < 2u ? (k == 0u ? slot[0] : slot[1]) : (k == 2u ? slot[2] : slot[3]);
        receivers[at].geometry = texelFetch(geometryImage, quadPixel(corner, k), 0);
        receivers[at].selfVisibility = texelFetch(selfVisibilityImage, quadPixel(corner, k), 0);
    }
}
