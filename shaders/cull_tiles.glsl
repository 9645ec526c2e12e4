// Lists of tiles of one slice. A group makes that of a tile: chunks of candidates, one a thread, of
// which those that reach the tile become hits; with pixels, those that reach one.
#define FRAME_ACCESS readonly
#define SHAPE_ACCESS readonly
#define FILLS_LISTS
#include "cull_lists.glsl"


shared uint hits[GROUP_MAX];   // shapes of the chunk
shared uint blocks[GROUP_MAX]; // that each of them reaches
shared uint places[GROUP_MAX]; // in the chunk
shared uint hit_bits[2];
shared uint category_counts[HDRP_CULL_CATEGORY_COUNT];

uint tile_index;
uint first_candidate;
uint candidate_count;
vec4 info; // of the tile
Window window;

#ifdef ASKS_PIXELS
#include "cull_pixels.glsl"
#endif

// The words of the bits of a chunk of candidates.
uint bits_of(uint from)
{
    uint tiles = frame.grid.tiles.z * frame.grid.tiles.w;
    uint words = (GROUP + 31u) / 32u; // of a chunk
    return tiles + (tile_index * ((frame.numbers.y + GROUP - 1u) / GROUP) + from / GROUP) * words;
}

// The hits of a chunk of candidates; returns how many. With a limit only those that have room.
uint collect(uint from, bool limited)
{
    uint candidate = from + gl_LocalInvocationIndex;
    uint index = 0u;
    uint total;
    bool found = false;
    if (candidate < candidate_count) {
        index = coarse[first_candidate + candidate];
#ifdef ASKS_PIXELS
        hdrp_cull_interval r = depths_in(window, index, seen_shapes[index], true);
#else
        hdrp_cull_interval r = depths_in(window, index, seen_shapes[index], false);
#endif
        found = r.nearest <= r.farthest && (!limited || is_kept(seen_shapes[index].order, index));
    }
    uint at = place_among(found, total);
    if (found) {
        hits[at] = index;
        places[at] = gl_LocalInvocationIndex;
        blocks[at] = 0xffffu;
    }
    wait_for_group();
#ifdef ASKS_PIXELS
    ask_pixels(total);
#endif
    return total;
}

// Notes which candidates of a chunk are hits: `places` has those that were asked, in order.
void note_hits(uint n, uint from)
{
    uint thread = gl_LocalInvocationIndex;
    if (thread < 2u) {
        hit_bits[thread] = 0u;
    }
    wait_for_group();
    if (thread < n && blocks[thread] != 0u) {
        atomicOr(hit_bits[places[thread] >> 5], 1u << (places[thread] & 31u));
    }
    wait_for_group();
    if (thread < (GROUP + 31u) / 32u) {
        dropped_of_tile[bits_of(from) + thread] = hit_bits[thread];
    }
}

// Adds the hits of a chunk to the sums of their digits.
void add_digits(uint from, int level)
{
    uint thread = gl_LocalInvocationIndex;
    if ((dropped_of_tile[bits_of(from) + (thread >> 5)] >> (thread & 31u) & 1u) != 0u) {
        uint index = coarse[first_candidate + from + thread];
        uint order = seen_shapes[index].order;
        if (leads_to_end(order, index, level)) {
            atomicAdd(sums[digit_of(order, index, level)], 1u);
        }
    }
}

// Writes the entries of a chunk, as far as there is room; returns how many there are.
uint write(uint n, uint written)
{
    uint thread = gl_LocalInvocationIndex;
    uint begin = tile_index * frame.grid.cells.y;
    uint total;
    bool found = thread < n && blocks[thread] != 0u;
    uint index = found ? hits[thread] : 0u;
    uint at = written + place_among(found, total);
    if (found && at < frame.grid.cells.y) {
        entries[begin + at] = index | blocks[thread] << 16;
        atomicAdd(category_counts[category_of(seen_shapes[index])], 1u);
#ifdef ASKS_PIXELS
        write_mask(begin + at, thread);
#endif
    }
    return total;
}

// One phase is enough where all entries fit. Others ask no pixels but those of what is kept.
#define PHASE_WRITE 0
#define PHASE_LEVEL 1
#define PHASE_AGAIN (PHASE_LEVEL + DIGITS)

void main()
{
    frame = frame_in_memory;
    uvec2 tile = gl_WorkGroupID.xy;
    uvec2 begin = tile * frame.grid.tiles.xy;
    uint written = 0u;
    uint all = 0u;
    tile_index = tile.y * frame.grid.tiles.z + tile.x;
    first_candidate = candidates_of(tile);
    candidate_count = coarse[first_candidate - 1u];
    info = tiles[tile_index];
    window = window_of(begin, begin + frame.grid.tiles.xy, info.x, info.y);
#ifdef ASKS_PIXELS
    begin_pixels(begin);
#endif
    begin_room();
    int phase = PHASE_WRITE;
    do { // asks at its end, as the loop inside does: see group.glsl
        bool level = phase >= PHASE_LEVEL && phase < PHASE_AGAIN;
        if (level) {
            begin_level();
        } else {
            all = written;
            written = 0u;
            if (gl_LocalInvocationIndex < HDRP_CULL_CATEGORY_COUNT) {
                category_counts[gl_LocalInvocationIndex] = 0u;
            }
        }
        uint from = 0u;
        do {
            if (level) {
                add_digits(from, phase - PHASE_LEVEL);
            } else {
                uint n = collect(from, phase == PHASE_AGAIN);
                if (phase == PHASE_WRITE) {
                    note_hits(n, from);
                }
                written += write(n, written);
                wait_for_group();
            }
            from += GROUP;
        } while (from < candidate_count);
        memoryBarrierBuffer(); // of the bits of hits
        wait_for_group();
        if (level) {
            end_level(phase - PHASE_LEVEL);
        }
        ++phase;
        if (phase == PHASE_LEVEL && written <= frame.grid.cells.y) {
            phase = PHASE_AGAIN + 1;
        }
    } while (phase <= PHASE_AGAIN);
    wait_for_group();
    uint missed = max(all, written) - written;
    if (gl_LocalInvocationIndex == 0u) {
        cells[tile_index] = uvec4(tile_index * frame.grid.cells.y,
                                  category_counts[0] | category_counts[1] << 16,
                                  category_counts[2] | category_counts[3] << 16, missed);
        dropped_of_tile[tile_index] = missed;
    }
}
