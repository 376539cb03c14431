// Rays against one surface at rest, and its normals: where a pointer is on the skin, and which way a probe's face looks
// there. Triangles are tried one by one, which takes about a millisecond for a hundred thousand.

import {Vector3} from "/three/build/three.module.js";

const TINY = 1e-30;

export class Surface {
    // positions: vertices x 3, m; triangles: corners, counter-clockwise from outside.
    constructor(positions, triangles) {
        this.positions = positions;
        this.triangles = triangles;
        this.normals = null;
    }

    // The first triangle that the ray meets in front of its origin, or null. direction is of length 1.
    cast(origin, direction) {
        let best = null;
        for (let i = 0; i < this.triangles.length; i += 3) {
            const hit = this.meet(i, origin, direction, best ? best.distance : Infinity);
            if (hit) best = hit;
        }
        if (best) best.point = new Vector3().copy(direction).multiplyScalar(best.distance).add(origin);
        return best;
    }

    // Where along the line through a place the surface is nearest to that place, in either direction, or null.
    nearestAlong(place, direction) {
        const ahead = this.cast(place, direction);
        const behind = this.cast(place, direction.clone().negate());
        if (!ahead || !behind) return ahead || behind;
        return ahead.distance <= behind.distance ? ahead : behind;
    }

    // Moller and Trumbore, Fast, minimum storage ray-triangle intersection, 1997.
    meet(i, o, d, limit) {
        const p = this.positions;
        const a = 3 * this.triangles[i];
        const b = 3 * this.triangles[i + 1];
        const c = 3 * this.triangles[i + 2];
        const e1x = p[b] - p[a], e1y = p[b + 1] - p[a + 1], e1z = p[b + 2] - p[a + 2];
        const e2x = p[c] - p[a], e2y = p[c + 1] - p[a + 1], e2z = p[c + 2] - p[a + 2];
        const hx = d.y * e2z - d.z * e2y, hy = d.z * e2x - d.x * e2z, hz = d.x * e2y - d.y * e2x;
        const determinant = e1x * hx + e1y * hy + e1z * hz;
        if (Math.abs(determinant) < TINY) return null;
        const sx = o.x - p[a], sy = o.y - p[a + 1], sz = o.z - p[a + 2];
        const u = (sx * hx + sy * hy + sz * hz) / determinant;
        if (u < 0 || u > 1) return null;
        const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
        const v = (d.x * qx + d.y * qy + d.z * qz) / determinant;
        if (v < 0 || u + v > 1) return null;
        const distance = (e2x * qx + e2y * qy + e2z * qz) / determinant;
        if (distance <= 1e-9 || distance >= limit) return null;
        return {distance, corners: [a / 3, b / 3, c / 3], weights: [1 - u - v, u, v]};
    }

    // The mean normal around a place, out of the body; weights fall to 0 at the radius. null: no vertex is so near.
    normalAt(place, radius) {
        if (!this.normals) this.normals = vertexNormals(this.positions, this.triangles);
        const sum = new Vector3();
        for (let i = 0; i < this.positions.length; i += 3) {
            const x = this.positions[i] - place.x;
            const y = this.positions[i + 1] - place.y;
            const z = this.positions[i + 2] - place.z;
            const left = 1 - (x * x + y * y + z * z) / (radius * radius);
            if (left <= 0) continue;
            sum.x += left * left * this.normals[i];
            sum.y += left * left * this.normals[i + 1];
            sum.z += left * left * this.normals[i + 2];
        }
        return sum.length() > 0 ? sum.normalize() : null;
    }

    // Of the triangle that was met.
    faceNormal(hit) {
        const [a, b, c] = hit.corners.map((i) => new Vector3().fromArray(this.positions, 3 * i));
        return b.sub(a).cross(c.sub(a)).normalize();
    }
}

// Sums of triangles' normals by area, not of length 1.
function vertexNormals(p, triangles) {
    const normals = new Float32Array(p.length);
    for (let i = 0; i < triangles.length; i += 3) {
        const [a, b, c] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2]];
        const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
        const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
        const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
        for (const corner of [a, b, c])
            for (let j = 0; j < 3; j++) normals[corner + j] += n[j];
    }
    return normals;
}
