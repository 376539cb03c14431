// The scene: the surfaces of a case, the probe, the image standing in its place, the camera. It draws when something
// changed, and keeps no state that the server has.

import * as THREE from "/three/build/three.module.js";
import {OrbitControls} from "/three/examples/jsm/controls/OrbitControls.js";

import {scaleBytes} from "./colours.js";
import {Item} from "./item.js";
import {boxHalf, boxMiddle} from "./protocol.js";
import {Raster} from "./raster.js";
import {imageFragment, imageVertex} from "./shaders.js";
import {parseShape, probeGroup, shapeUniforms} from "./shapes.js";

const CLEAR = 0x15181b;
const SKIN = 0.4;         // how solid it is over vessels
const PROBE_ROOM = 0.07;  // m

// ms: drawings that cost more leave as long again; that cost more become coarser; and when all is still, fine again.
const SLOW = 25;
const MOST_REST = 250;
const COARSE = 40;
const STILL = 700;
const LEAST_FINE = 0.6;
// The same of drawings by the processor, which the tools and the image need too.
const BY_PROCESSOR = 0.3;
const SMOOTH = 1e6;  // pixels

// Whether there is no graphics card: then raster.js draws. `?draw=webgl` and `?draw=processor` in the page's address
// choose, to compare them. Throws where the browser has no WebGL 2.
function drawsByProcessor() {
    const asked = new URLSearchParams(location.search).get("draw");
    const context = document.createElement("canvas").getContext("webgl2");
    if (!context) throw new Error("this browser has no WebGL 2, which the view of the patient needs");
    const names = context.getExtension("WEBGL_debug_renderer_info");
    const name = names ? context.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
    const lose = context.getExtension("WEBGL_lose_context");
    if (lose) lose.loseContext();
    return asked ? asked === "processor" : /swiftshader|llvmpipe|software/i.test(name);
}

export class View {
    // Throws where the browser has no WebGL 2.
    constructor(canvas) {
        this.canvas = canvas;
        if (drawsByProcessor()) this.raster = new Raster(canvas);
        else this.openRenderer();
        this.scene = new THREE.Scene();
        this.camera = new THREE.PerspectiveCamera(35, 1, 0.001, 10);
        [this.slow, this.coarse] = [SLOW, COARSE].map((ms) => (this.raster ? BY_PROCESSOR * ms : ms));
        this.items = new Map();  // by the server's number
        this.shape = null;
        this.probe = null;
        this.frames = 0;
        this.cost = 0;      // ms: of a drawing, smoothed
        this.rested = 0;    // ms: when the next may begin
        this.fineness = 1;  // pixels drawn to those of the screen, along a side
        this.scale = new THREE.DataTexture(scaleBytes(), 256, 1, THREE.RGBAFormat);
        this.scale.needsUpdate = true;
        this.light();
        this.image = this.makeImage();
        this.toProbe = new THREE.Matrix4();
        this.box = [-0.05, -0.05, -0.05, 0.05, 0.05, 0.05];
        this.up = [0, 0, 1];
        this.seen = this.box;  // what the camera takes in
        this.drawn = [];       // called after each drawing
        this.waiting = [];     // called after the next one
        this.told = {};
        new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
        this.resize();
    }

    openRenderer() {
        const context = this.canvas.getContext("webgl2", {antialias: true, powerPreference: "high-performance"});
        if (!context) throw new Error("this browser has no WebGL 2, which the view of the patient needs");
        this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, context});
        this.renderer.setClearColor(CLEAR);
    }

    // After all other listeners of the canvas, which may keep an event from it.
    control() {
        this.placeOrbit();
        this.reset();
    }

    light() {
        this.sky = new THREE.HemisphereLight(0xe8eef2, 0x6b747c, 0.7);
        const key = new THREE.DirectionalLight(0xffffff, 0.6);
        key.position.set(0.4, 0.6, 1);
        key.target.position.set(0, 0, -1);
        this.camera.add(key, key.target);
        this.scene.add(this.sky);
        this.scene.add(this.camera);
    }

    // ---- drawing

    // Draws soon. Where a drawing takes long, as without a graphics card, as much time again is left for all else, and
    // while things move the picture is coarser; it is as fine as the screen when nothing has moved for a while.
    request() {
        if (this.asked) return;
        this.asked = true;
        clearTimeout(this.still);
        const wait = this.cost > this.slow ? this.rested - performance.now() : 0;
        if (wait > 1) setTimeout(() => this.begin(), wait);
        else this.begin();
    }

    // What draws by the processor begins when the browser has shown all else, so that no image waits for it.
    begin() {
        requestAnimationFrame(() => (this.raster ? setTimeout(() => this.render()) : this.render()));
    }

    // Calls after the drawing that is asked for.
    after(call) {
        this.waiting.push(call);
    }

    render() {
        const began = performance.now();
        this.asked = false;
        this.draw(this.fineness);
        for (const call of this.waiting.splice(0)) call();
        // A task of its own comes after the browser has drawn.
        setTimeout(() => this.rate(performance.now() - began));
    }

    // fineness: pixels drawn to those of the screen, along a side. Another size of the canvas clears it.
    draw(fineness) {
        const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
        const size = [width, height, fineness * Math.min(window.devicePixelRatio || 1, 2)];
        if (!width || !height) return;
        if (size.join() !== this.drawnSize) {
            this.drawnSize = size.join();
            this.pixels = width * height * (window.devicePixelRatio || 1) ** 2;  // of the screen
            this.setSize(...size);
        }
        if (this.raster) this.raster.render(this);
        else this.renderer.render(this.scene, this.camera);
        this.frames++;
        for (const tell of this.drawn) tell();
    }

    setSize(width, height, ratio) {
        if (this.raster) {
            this.raster.setSize(Math.round(width * ratio), Math.round(height * ratio));
            return;
        }
        this.renderer.setPixelRatio(ratio);
        this.renderer.setSize(width, height, false);
    }

    // Takes what a drawing cost, ms.
    rate(cost) {
        this.cost = 0.7 * this.cost + 0.3 * cost;
        this.rested = performance.now() + Math.min(cost, MOST_REST);
        if (this.cost > this.coarse && this.fineness > LEAST_FINE) this.setFineness(this.fineness * 0.8);
        else if (this.cost < this.coarse / 4 && this.fineness < 1) this.setFineness(Math.min(this.fineness / 0.8, 1));
        clearTimeout(this.still);
        if (this.fineness < this.finest() && !this.asked)
            this.still = setTimeout(() => this.draw(this.finest()), STILL);
    }

    // When nothing moves. The processor then draws four pixels for each of a screen that is not too large: their mean
    // has smooth edges, as a graphics card makes them.
    finest() {
        return this.raster && this.pixels < SMOOTH ? 2 : 1;
    }

    // Of the next drawings; what they cost is to be learnt anew.
    setFineness(fineness) {
        this.fineness = fineness;
        this.cost = this.coarse / 2;
    }

    resize() {
        const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
        if (!width || !height) return;
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
        // The whole case stays in the picture, unless a hand has moved the camera.
        if (this.orbit && this.standing) this.look(...this.standing);
        this.request();
    }

    // Whether what is to be shown differs from what was, by its text.
    isNews(name, what) {
        const text = JSON.stringify(what);
        const is = this.told[name] !== text;
        this.told[name] = text;
        return is;
    }

    // ---- surfaces

    // kind: of the case; a skin under a probe is seen through.
    setGeometry(geometry, kind) {
        this.seesThrough = kind === "ultrasound";
        for (const item of this.items.values()) this.drop(item);
        this.items.clear();
        this.told = {};
        if (this.probe) this.scene.remove(this.probe);
        this.probe = null;
        this.probePose = null;
        this.givenProbe = null;
        this.box = geometry.box || this.box;
        this.up = geometry.up || this.up;
        this.seen = this.roomToShow();
        this.sky.position.fromArray(this.up);
        for (const mesh of geometry.meshes) {
            if (mesh.kind === "probe") this.givenProbe = mesh;
            else this.addItem(mesh);
        }
        this.setProbe(this.shapeWords);
        this.reset();
    }

    // The case, and room for a probe above it.
    roomToShow() {
        const box = [...this.box];
        if (this.seesThrough)
            for (let i = 0; i < 3; i++) box[this.up[i] > 0 ? i + 3 : i] += PROBE_ROOM * this.up[i];
        return box;
    }

    addMesh(geometry, material) {
        const mesh = new THREE.Mesh(geometry, material);
        mesh.frustumCulled = false;
        this.scene.add(mesh);
        return mesh;
    }

    addItem(mesh) {
        const shared = {scale: this.scale, toProbe: this.toProbe};
        const item = new Item(mesh, shared, mesh.kind === "skin" && this.seesThrough ? SKIN : 1);
        this.items.set(mesh.id, item);
        this.scene.add(item.solid, item.first);
    }

    drop(item) {
        this.scene.remove(item.solid, item.first);
        item.dispose();
    }

    named(name) {
        return [...this.items.values()].find((item) => item.name === name);
    }

    // What pointers meet: the skin, else the body's own surface.
    touchable() {
        const all = [...this.items.values()];
        return ["skin", "mesh"].map((kind) => all.find((item) => item.kind === kind)).find(Boolean) || all[0];
    }

    // How an item is shown.
    show(item, visible, opacity) {
        item.setOpacity(opacity);
        item.setVisible(visible);
        this.request();
    }

    // Tissue at rest is not drawn again.
    setPositions(message) {
        let changed = false;
        for (const part of message.parts) {
            const item = this.items.get(part.id);
            if (item && part.count === item.count) changed = item.take(part) || changed;
        }
        if (changed) this.request();
    }

    // As Item.setColouring has it.
    colourBy(colouring, low, high) {
        const items = [...this.items.values()];
        if (!this.isNews("colouring", [colouring, low, high, items.map((item) => item.range)])) return;
        for (const item of items) item.setColouring(colouring, low, high);
        this.request();
    }

    // ---- probe and image

    setProbe(words) {
        this.shapeWords = words;
        const shape = parseShape(words);
        const visible = this.probe ? this.probe.visible : true;
        if (this.probe) this.scene.remove(this.probe);
        this.shape = shape;
        this.probe = null;
        if (shape || this.givenProbe) {
            this.probe = probeGroup(shape, shape ? null : this.givenGeometry());
            this.probe.visible = visible && Boolean(this.probePose);
            this.scene.add(this.probe);
        }
        if (this.probePose) this.poseProbe(this.probePose);
    }

    givenGeometry() {
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.BufferAttribute(this.givenProbe.positions, 3));
        geometry.setIndex(new THREE.BufferAttribute(this.givenProbe.triangles, 1));
        geometry.computeVertexNormals();
        return geometry;
    }

    poseProbe(pose) {
        this.probePose = pose;
        if (!this.probe) return;
        if (this.probeHidden !== true) this.probe.visible = true;
        this.probe.position.fromArray(pose, 0);
        this.probe.quaternion.fromArray(pose, 3);
        this.probe.updateMatrixWorld();
        this.request();
    }

    showProbe(visible) {
        this.probeHidden = !visible;
        if (this.probe) this.probe.visible = visible;
        this.request();
    }

    // Where the skin is tinted: against the probe as the tool had it; nowhere where nothing touches.
    setContact(pose, touches) {
        const {kind, size} = shapeUniforms(touches ? this.shape : null);
        if (!this.isNews("contact", [kind, size, touches && pose])) return;
        if (pose) {
            const place = new THREE.Vector3().fromArray(pose, 0);
            const turn = new THREE.Quaternion().fromArray(pose, 3);
            this.toProbe.getInverse(new THREE.Matrix4().compose(place, turn, new THREE.Vector3(1, 1, 1)));
        }
        for (const item of this.items.values()) item.setContact(kind, size);
        this.request();
    }

    makeImage() {
        const material = new THREE.ShaderMaterial({
            vertexShader: imageVertex,
            fragmentShader: imageFragment,
            side: THREE.DoubleSide,
            uniforms: {
                pixels: {value: null},
                corner: {value: new THREE.Vector3()},
                along: {value: new THREE.Vector3()},
                down: {value: new THREE.Vector3()},
                size: {value: new THREE.Vector2(1, 1)},
                fan: {value: new THREE.Vector4()},
                opacity: {value: 1},
            },
        });
        const mesh = this.addMesh(new THREE.PlaneBufferGeometry(1, 1), material);
        mesh.visible = false;
        return {mesh, material, wanted: true};
    }

    // image: as decoded; canvas: its pixels; fan: {radius, angle} of a curved or phased array, or null.
    setImage(image, canvas, fan) {
        const uniforms = this.image.material.uniforms;
        const [column, row] = [image.column, image.row].map((step) => new THREE.Vector3().fromArray(step));
        const corner =
            new THREE.Vector3().fromArray(image.origin).addScaledVector(column, -0.5).addScaledVector(row, -0.5);
        uniforms.corner.value.copy(corner);
        uniforms.along.value.copy(column).multiplyScalar(image.columns);
        uniforms.down.value.copy(row).multiplyScalar(image.rows);
        uniforms.size.value.set(column.length() * image.columns, row.length() * image.rows);
        this.setTexture(canvas);
        this.setFan(fan, uniforms.size.value);
        this.image.mesh.visible = this.image.wanted;
        this.request();
    }

    setTexture(canvas) {
        const {pixels} = this.image.material.uniforms;
        const old = pixels.value;
        if (!old || this.textureSize !== [canvas.width, canvas.height].join()) {
            if (old) old.dispose();
            pixels.value = new THREE.Texture(canvas);
            pixels.value.flipY = false;
            pixels.value.minFilter = THREE.LinearMipmapLinearFilter;
        }
        this.textureSize = [canvas.width, canvas.height].join();
        pixels.value.needsUpdate = true;
    }

    // The first row of a fan's image begins where the ends of its face are.
    setFan(fan, size) {
        const value = this.image.material.uniforms.fan.value;
        if (!fan) value.set(0, 0, 0, 0);
        else value.set(size.x / 2, -fan.radius * Math.cos(fan.angle / 2), fan.radius, fan.angle / 2);
    }

    clearImage() {
        const {pixels} = this.image.material.uniforms;
        if (pixels.value) pixels.value.dispose();
        pixels.value = null;
        this.image.mesh.visible = false;
    }

    showImage(visible, opacity) {
        this.image.wanted = visible;
        this.image.mesh.visible = visible && Boolean(this.image.material.uniforms.pixels.value);
        this.image.material.uniforms.opacity.value = opacity;
        this.image.material.transparent = opacity < 1;
        this.request();
    }

    // ---- camera

    middle() {
        return new THREE.Vector3().fromArray(boxMiddle(this.seen));
    }

    size() {
        return Math.hypot(...boxHalf(this.box));
    }

    // Sideways and forward, across up.
    axes() {
        const up = new THREE.Vector3().fromArray(this.up).normalize();
        const right = new THREE.Vector3(1, 0, 0);
        if (Math.abs(right.dot(up)) > 0.9) right.set(0, 1, 0);
        right.addScaledVector(up, -right.dot(up)).normalize();
        return {up, right, back: right.clone().cross(up)};
    }

    // Looks from a side at all of the case: numbers along right, toward the viewer, and up.
    look(right, back, up) {
        const axes = this.axes();
        const from = axes.right.multiplyScalar(right).addScaledVector(axes.back, back).addScaledVector(axes.up, up);
        const far = 1.12 * this.distanceToFit(from.normalize(), axes.up);
        this.camera.up.copy(axes.up);
        this.camera.near = far / 100;
        this.camera.far = far * 20;
        this.camera.updateProjectionMatrix();
        this.camera.position.copy(this.middle()).addScaledVector(from, far);
        this.standing = [right, back, up];
        if (this.orbit) this.placeOrbit();
        this.request();
    }

    // m: from the middle, at which all corners of the box are within the picture.
    distanceToFit(from, up) {
        const across = up.clone().cross(from).normalize();
        const over = from.clone().cross(across);
        const half = boxHalf(this.seen);
        const high = Math.tan((this.camera.fov * Math.PI) / 360);
        let most = 0.01;
        for (let i = 0; i < 8; i++) {
            const corner = new THREE.Vector3().fromArray(half.map((x, axis) => ((i >> axis) & 1 ? x : -x)));
            const wide = Math.abs(corner.dot(across)) / (high * this.camera.aspect);
            most = Math.max(most, Math.max(wide, Math.abs(corner.dot(over)) / high) + corner.dot(from));
        }
        return most;
    }

    // OrbitControls takes its axis when it is made.
    placeOrbit() {
        if (this.orbit) this.orbit.dispose();
        this.orbit = new OrbitControls(this.camera, this.canvas);
        this.orbit.enableKeys = false;
        this.orbit.screenSpacePanning = true;
        this.orbit.target.copy(this.middle());
        this.orbit.addEventListener("change", () => this.request());
        this.orbit.addEventListener("start", () => (this.standing = null));
        this.orbit.update();
    }

    reset() {
        if (this.seesThrough) this.look(0.45, 1, 0.55);
        else this.look(0.2, 1, 0.1);
    }

    zoom(factor) {
        this.standing = null;
        const away = this.camera.position.clone().sub(this.orbit.target).multiplyScalar(factor);
        this.camera.position.copy(this.orbit.target).add(away);
        this.orbit.update();
        this.request();
    }

    turn(right, up) {
        this.standing = null;
        const away = this.camera.position.clone().sub(this.orbit.target);
        const side = new THREE.Vector3(1, 0, 0).applyQuaternion(this.camera.quaternion);
        away.applyAxisAngle(this.camera.up, right).applyAxisAngle(side, up);
        if (away.angleTo(this.camera.up) < 0.05 || away.angleTo(this.camera.up) > Math.PI - 0.05) return;
        this.camera.position.copy(this.orbit.target).add(away);
        this.orbit.update();
        this.request();
    }

    // ---- pointers, in pixels of the page

    ray(x, y) {
        const frame = this.canvas.getBoundingClientRect();
        const at = {x: (2 * (x - frame.left)) / frame.width - 1, y: 1 - (2 * (y - frame.top)) / frame.height};
        const caster = new THREE.Raycaster();
        this.camera.updateMatrixWorld();
        caster.setFromCamera(at, this.camera);
        return caster.ray;
    }

    project(place) {
        const frame = this.canvas.getBoundingClientRect();
        this.camera.updateMatrixWorld();
        const at = place.clone().project(this.camera);
        return [frame.left + ((at.x + 1) / 2) * frame.width, frame.top + ((1 - at.y) / 2) * frame.height];
    }

    // How far along a ray the probe is met, or Infinity.
    meetProbe(ray) {
        if (!this.probe || !this.probe.visible) return Infinity;
        const hits = new THREE.Raycaster(ray.origin, ray.direction).intersectObject(this.probe, true);
        return hits.length ? hits[0].distance : Infinity;
    }
}
