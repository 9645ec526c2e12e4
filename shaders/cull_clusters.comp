#version 450
// Lists of tiles with slices: clusters. A group makes those of a tile. Candidates go through shared
// memory in batches; a thread has some slices, and picks from each batch what reaches them.
// header: hdrp_gpu_vk_cull.h
// contraction: none
#extension GL_GOOGLE_include_directive : require
#define FRAME_ACCESS readonly
#define SHAPE_ACCESS readonly
#define FILLS_LISTS
#include "cull_lists.glsl"

#define BATCH 1024


shared uint hits[BATCH]; // candidate of the batch | category << 10 | first slice << 12 | last << 20
shared uint needed;      // entries of all hits
shared uint dropped;
shared uint scan[GROUP_MAX];
// Of each slice the counts of the four categories, 16 bits each; then in x where its next entry goes.
shared uvec2 counts[HDRP_CULL_SLICES_MAX];

uint tile_index;
uint first_candidate;
uint candidate_count;
float scale;

// The slices of a candidate, as hits keep them; false where it misses the tile.
bool ask(uint candidate, out uint hit)
{
    uint index = coarse[first_candidate + candidate];
    uvec2 begin = gl_WorkGroupID.xy * frame.grid.tiles.xy;
    Window window = window_of(begin, begin + frame.grid.tiles.xy, frame.pixel.z, frame.pixel.w);
    hdrp_cull_interval r = depths_in(window, index, seen_shapes[index], false);
    hit = candidate % BATCH | category_of(seen_shapes[index]) << 10 |
          hdrp_cull_slice(frame.grid, scale, r.nearest) << 12 |
          hdrp_cull_slice(frame.grid, scale, r.farthest) << 20;
    return r.nearest <= r.farthest;
}

uint slices_of(uint hit)
{
    return 1u + (hit >> 20) - (hit >> 12 & 255u);
}

bool has_room(uint index)
{
    return is_kept(seen_shapes[index].order, index);
}

// The hits of a batch in order; returns how many. With a limit those without room are left out.
uint collect(uint batch, bool limited)
{
    uint end = min((batch + 1u) * BATCH, candidate_count);
    uint n = 0u;
    uint from = batch * BATCH;
    do {
        uint candidate = from + gl_LocalInvocationIndex;
        uint hit, total;
        bool found = candidate < end && ask(candidate, hit);
        if (found && limited && !has_room(coarse[first_candidate + candidate])) {
            atomicAdd(dropped, 1u); // what cells say is read before they are asked once more
            found = false;
        }
        uint at = n + place_among(found, total);
        if (found) {
            hits[at] = hit;
        }
        n += total;
        from += GROUP;
    } while (from < end);
    wait_for_group();
    return n;
}

uint candidate_of(uint batch, uint hit)
{
    return coarse[first_candidate + batch * BATCH + (hit & (BATCH - 1u))];
}

// Adds the entries of some hits to what is needed.
void add_needed(uint n)
{
    uint sum = 0u;
    for (uint h = gl_LocalInvocationIndex; h < n; h += GROUP) {
        sum += slices_of(hits[h]);
    }
    if (sum > 0u) {
        atomicAdd(needed, sum);
    }
}

// Adds the entries of some hits to the sums of their digits.
void add_digits(uint batch, uint n, int level)
{
    for (uint h = gl_LocalInvocationIndex; h < n; h += GROUP) {
        uint index = candidate_of(batch, hits[h]);
        uint order = seen_shapes[index].order;
        if (leads_to_end(order, index, level)) {
            atomicAdd(sums[digit_of(order, index, level)], slices_of(hits[h]));
        }
    }
}

// The slices of a thread follow each other.
uint first_slice()
{
    return gl_LocalInvocationIndex * ((frame.grid.cells.x + GROUP - 1u) / GROUP);
}

uint end_slice()
{
    uint of_thread = (frame.grid.cells.x + GROUP - 1u) / GROUP;
    return min(first_slice() + of_thread, frame.grid.cells.x);
}

uvec2 one_more(uvec2 counts, uint category)
{
    uint one = 1u << ((category & 1u) << 4);
    return counts + (category < 2u ? uvec2(one, 0u) : uvec2(0u, one));
}

uint sum_of(uvec2 counts)
{
    return (counts.x & 0xffffu) + (counts.x >> 16) + (counts.y & 0xffffu) + (counts.y >> 16);
}

// The slices of a thread that a hit reaches.
uint begin_in(uint first, uint hit)
{
    return max(first, hit >> 12 & 255u);
}

uint end_in(uint end, uint hit)
{
    return min(end, 1u + (hit >> 20));
}

void count_slices(uint n)
{
    uint first = first_slice();
    uint end = end_slice();
    for (uint h = 0u; h < n; ++h) {
        uint hit = hits[h];
        uint k = begin_in(first, hit);
        uint last = end_in(end, hit);
        do {
            if (k < last) {
                counts[k] = one_more(counts[k], hit >> 10 & 3u);
            }
        } while (++k < last);
    }
}

// Where the entries of each thread begin, after those of the threads before it.
uint place_of_thread(uint own)
{
    uint thread = gl_LocalInvocationIndex;
    scan[thread] = own;
    wait_for_group();
    for (uint step = 1u; step < GROUP; step <<= 1) {
        uint before = thread >= step ? scan[thread - step] : 0u;
        wait_for_group();
        scan[thread] += before;
        wait_for_group();
    }
    return scan[thread] - own;
}

void write_entries(uint batch, uint n)
{
    uint first = first_slice();
    uint end = end_slice();
    for (uint h = 0u; h < n; ++h) {
        uint hit = hits[h];
        uint k = begin_in(first, hit);
        uint last = end_in(end, hit);
        do {
            if (k < last) {
                entries[counts[k].x++] = candidate_of(batch, hit) | 0xffff0000u;
            }
        } while (++k < last);
    }
}

// Writes the cells of a thread.
void write_cells()
{
    uint own = 0u;
    for (uint k = first_slice(); k < end_slice(); ++k) {
        own += sum_of(counts[k]);
    }
    uint at = tile_index * frame.grid.cells.y + place_of_thread(own);
    for (uint k = first_slice(); k < end_slice(); ++k) {
        uvec2 of_slice = counts[k];
        cells[tile_index * frame.grid.cells.x + k] = uvec4(at, of_slice, dropped);
        counts[k].x = at;
        at += sum_of(of_slice);
    }
    if (gl_LocalInvocationIndex == 0u) {
        dropped_of_tile[tile_index] = dropped;
    }
}

// Candidates are asked again in each phase, but for those of a single batch, whose hits stay.
#define PHASE_MEASURE 0
#define PHASE_LEVEL   1 // and the ones after it, where entries do not fit
#define PHASE_COUNT   (PHASE_LEVEL + DIGITS)
#define PHASE_WRITE   (PHASE_COUNT + 1)

void main()
{
    frame = frame_in_memory;
    uvec2 tile = gl_WorkGroupID.xy;
    uvec2 begin = tile * frame.grid.tiles.xy;
    uint n = 0u;
    tile_index = tile.y * frame.grid.tiles.z + tile.x;
    first_candidate = candidates_of(tile);
    candidate_count = coarse[first_candidate - 1u];
    scale = tiles[tile_index].z;
    uint batches = (candidate_count + BATCH - 1u) / BATCH;
    bool limited = false;
    if (gl_LocalInvocationIndex == 0u) {
        needed = 0u;
        dropped = 0u;
    }
    for (uint k = first_slice(); k < end_slice(); ++k) {
        counts[k] = uvec2(0u);
    }
    begin_room();
    wait_for_group();
    int phase = PHASE_MEASURE;
    do { // asks at its end, as the loop inside does: see group.glsl
        bool level = phase >= PHASE_LEVEL && phase < PHASE_COUNT;
        bool is_new = phase == PHASE_MEASURE || batches > 1u || (limited && phase == PHASE_COUNT);
        if (level) {
            begin_level();
        }
        if (phase == PHASE_WRITE) {
            write_cells();
        }
        if (phase == PHASE_COUNT && gl_LocalInvocationIndex == 0u) {
            dropped = 0u;
        }
        wait_for_group();
        uint b = 0u;
        do {
            if (is_new) {
                n = collect(b, limited && phase >= PHASE_COUNT);
            }
            if (phase == PHASE_MEASURE) {
                add_needed(n);
            } else if (level) {
                add_digits(b, n, phase - PHASE_LEVEL);
            } else if (phase == PHASE_COUNT) {
                count_slices(n);
            } else {
                write_entries(b, n);
            }
            wait_for_group();
        } while (++b < batches);
        if (level) {
            end_level(phase - PHASE_LEVEL);
        }
        ++phase;
        if (phase == PHASE_LEVEL) {
            limited = needed > frame.grid.cells.y;
            phase = limited ? phase : PHASE_COUNT;
        }
    } while (phase <= PHASE_WRITE);
}
