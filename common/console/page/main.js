// The page: its connection to the server, what it knows, and the parts that show it. `sinew`, a global, has all that
// the page knows, for those who test or measure it.

import {Face} from "./face.js";
import {Image} from "./image.js";
import {Cases, Forces, Method, Said, Shown} from "./panels.js";
import {Probe} from "./probe.js";
import {decode} from "./protocol.js";
import {parseShape} from "./shapes.js";
import {View} from "./view.js";
import {byId, figures} from "./widgets.js";

const KEPT = 2000;     // poses, frames and images whose times are kept
const POSE_PACE = 12;  // ms, at least, between two poses

const sinew = {
    connected: false,
    state: null,
    frame: null,
    image: null,  // the one that is shown
    geometry: null,
    positions: 0,  // messages of them
    poses: [],     // {at: ms, pose}: as they were sent
    frames: [],    // {at: ms, index, pose}: as they came
    images: [],    // {at: ms, index, face: m}: when they were drawn
    sent: [],      // lines
    said: [],
    problem: null,
};
window.sinew = sinew;

function keep(list, what) {
    list.push(what);
    if (list.length > KEPT) list.splice(0, KEPT / 2);
}

// ---- the connection

const link = new Worker("link.js");

function send(line) {
    keep(sinew.sent, line);
    link.postMessage({send: line});
}

// On this machine images need not be compressed, unless `?pixels=jpeg` says so, as behind a tunnel.
function takesRaw(words) {
    return ["127.0.0.1", "localhost", "[::1]"].includes(location.hostname) && words.get("pixels") !== "jpeg";
}

function connect() {
    const words = new URLSearchParams(location.search);
    const token = words.get("token");
    const way = location.protocol === "https:" ? "wss:" : "ws:";
    link.onmessage = ({data}) => {
        if (data.open !== undefined) connected(data.open);
        else if (data.problem) problem(data.problem);
        else takeNext(data.data);
    };
    const address = `${way}//${location.host}/live${token ? `?token=${encodeURIComponent(token)}` : ""}`;
    link.postMessage({address, raw: takesRaw(words)});
}

function takeNext(data) {
    receive(data);
    link.postMessage({done: true});
}

function connected(is) {
    sinew.connected = is;
    document.body.classList.toggle("offline", !is);
    byId("connection").textContent = is ? "connected" : "no connection to sinew console; trying again";
}

function receive(data) {
    try {
        if (typeof data === "string") takeText(JSON.parse(data));
        else if (data.header) image.take(decode(data.header), data.pixels);
        else takeBinary(decode(data));
    } catch (error) {
        problem(`a message that this page cannot read: ${error.message}`);
    }
}

function takeText(message) {
    if (message.type === "state") takeState(message);
    else if (message.type === "frame") takeFrame(message);
    else if (message.type === "said") takeSaid(message);
    else if (message.type === "saved") takeSaid({level: "info", text: `saved: ${message.name}`, href: message.url});
}

function takeBinary(message) {
    if (message.kind === "image") image.take(message, message.pixels);
    else if (message.kind === "geometry") takeGeometry(message);
    else takePositions(message);
}

// ---- the parts

function problem(text) {
    sinew.problem = text;
    said.add({level: "error", tool: "page", text});
}

// null where there is no WebGL 2: all else works.
function makeView() {
    try {
        return new View(byId("view"));
    } catch (error) {
        problem(`${error.message}; images and forces are shown all the same`);
        byId("no-view").textContent = `No view of the patient: ${error.message}.`;
        byId("no-view").hidden = false;
        return null;
    }
}

// At least so long between two poses, of which the last always goes.
function poseSender() {
    let newest = null;
    let waits = false;
    const go = () => {
        waits = newest !== null;
        if (!waits) return;
        keep(sinew.poses, {at: performance.now(), pose: newest});
        send(`pose ${newest.map((x) => Number(x.toPrecision(12))).join(" ")}`);
        newest = null;
        setTimeout(go, POSE_PACE);
    };
    return (pose) => {
        newest = pose;
        if (!waits) go();
    };
}

const said = new Said();
const view = makeView();
const probe = view && new Probe(view, poseSender());
const face = view && new Face(view, send);
const image = new Image((key, value) => send(`image ${key} ${value}`), imageShown);
const cases = new Cases((name) => send(`open ${name}`));
const method = new Method(send);
const shown = view && new Shown(view);
const forces = new Forces();
Object.assign(sinew, {view, probe, face, imageView: image, send});
if (view) {
    view.control();
    byId("probe-panel").append(...probe.build());
}

// ---- what comes

function takeState(state) {
    const before = sinew.state;
    sinew.state = state;
    if (!before || before.case !== state.case) newCase();
    document.body.dataset.kind = state.kind || "none";
    document.body.classList.toggle("paused", Boolean(state.paused));
    cases.set(state);
    method.set(state.tool || {});
    image.setSettings(state.image && (state.image.settings || state.image));
    takeShape(state);
    if (face) face.set(state);
    showRun(state);
    if (!state.case && !before && (state.cases || []).length) byId("cases").showModal();
}

function newCase() {
    sinew.frame = null;
    image.clear();
    forces.clear();
}

function takeShape(state) {
    const shape = typeof state.probe === "string" ? state.probe : (state.probe || {}).shape;
    byId("shape").hidden = !shape;
    byId("from").textContent = (state.probe || {}).from || "hand";
    if (!view) return;
    if (shape !== view.shapeWords) {
        view.setProbe(shape);
        showShape(shape);
    }
    if (state.probe && state.probe.pose) probe.follow(state.probe.pose);
}

// The list of shapes, with the one that is there even where it is no usual one.
function showShape(shape) {
    const select = byId("shape");
    const own = [...select.options].find((option) => option.dataset.own);
    if (own) own.remove();
    if (shape && ![...select.options].some((option) => option.value === shape)) {
        select.add(new Option(shape, shape));
        select.options[select.options.length - 1].dataset.own = "true";
    }
    select.value = shape || "";
}

function takeGeometry(geometry) {
    sinew.geometry = geometry;
    if (!view) return;
    view.clearImage();
    view.setGeometry(geometry, (sinew.state || {}).kind);
    probe.setGeometry();
    face.setGeometry();
    shown.hasImage = (sinew.state || {}).kind === "ultrasound";
    shown.set((sinew.state || {}).case);
    if (sinew.state) face.set(sinew.state);  // its pulls need the surfaces
    const pose = (sinew.frame && sinew.frame.pose) || ((sinew.state || {}).probe || {}).pose;
    if (pose) probe.follow(pose);
}

function takePositions(message) {
    sinew.positions++;
    if (view) {
        view.setPositions(message);
        face.moved();
    }
    // The next is of use when these were drawn.
    if (view && view.asked) view.after(() => link.postMessage({drawn: true}));
    else link.postMessage({drawn: true});
}

function takeFrame(frame) {
    sinew.frame = frame;
    keep(sinew.frames, {at: performance.now(), index: frame.index, pose: frame.pose});
    forces.add(frame);
    showFrame(frame);
    if (!view || !frame.pose) return;
    view.setContact(frame.pose, touches(frame));
    probe.follow(frame.pose);
}

// Whether anything touches the probe: where that is not counted, a force says so.
function touches({contacts, force}) {
    return Number.isFinite(contacts) ? contacts > 0 : Math.hypot(...(force || [0])) > 0;
}

// Where the middle of the probe's face was, from the first row of its image; not so of fans.
function faceOf({origin, column, row, columns}) {
    return origin.map((x, i) => x + column[i] * (columns - 1) / 2 - row[i] / 2);
}

function imageShown(now, pixels) {
    sinew.image = now;
    const shown = {at: null, index: now.index, face: faceOf(now)};
    keep(sinew.images, shown);
    image.after(() => (shown.at = performance.now()));
    if (!view || !pixels) return;
    const shape = sinew.state && sinew.state.probe;
    view.setImage(now, pixels, image.fan(typeof shape === "string" ? shape : (shape || {}).shape));
}

function takeSaid(message) {
    keep(sinew.said, message);
    said.add(message);
}

// ---- the line above all

function showFrame(frame) {
    const parts = [];
    if (Number.isFinite(frame.ratio)) parts.push(`real time × ${frame.ratio.toFixed(2)}`);
    if (Number.isFinite(frame.lag)) parts.push(`lag ${figures(frame.lag, 2)} ms`);
    if (Number.isFinite(frame.time)) parts.push(`${frame.time.toFixed(1)} s`);
    byId("pace").textContent = parts.join("  ·  ");
}

function showRun(state) {
    byId("device").textContent = (state.device || "").split(" (")[0];
    byId("device").title = `Where the tissue is computed: ${state.device || "not known yet"}`;
    byId("pause").setAttribute("aria-pressed", Boolean(state.paused));
    byId("pause").textContent = state.paused ? "Go on" : "Pause";
    byId("step").disabled = !state.paused;
    byId("record").setAttribute("aria-pressed", Boolean(state.recording));
    byId("replay").setAttribute("aria-pressed", Boolean(state.replaying));
    const gone = childrenOf(state).filter((child) => !child.alive);
    const dead = gone.map((child) => `${child.tool} has ended${child.why ? `: ${child.why}` : ""}`).join("; ");
    byId("children").textContent = dead;
    byId("children").hidden = !dead;
    const empty = !state.case && view;
    if (view) byId("no-view").hidden = !empty;
    if (empty) byId("no-view").textContent = state.why || "No case is open. Choose one from the list of cases.";
}

function childrenOf(state) {
    const children = state.children || [];
    return Array.isArray(children) ? children : Object.entries(children).map(([tool, is]) => ({tool, ...is}));
}

function button(id, act) {
    byId(id).addEventListener("click", act);
}

const is = (what) => Boolean((sinew.state || {})[what]);
button("pause", () => send(`pause ${is("paused") ? "off" : "on"}`));
button("step", () => send("step"));
button("restart", () => send("reset"));
button("record", () => send(`record ${is("recording") ? "off" : "on"}`));
button("replay", () => send("replay"));
button("save-image", () => send("save image"));
button("save-model", () => send("save model"));
button("open-keys", () => byId("keys").showModal());
byId("shape").addEventListener("change", () => send(`set probe ${byId("shape").value}`));

// ---- the camera, and keys

const SIDES = {
    front: [0, 1, 0],
    back: [0, -1, 0],
    left: [-1, 0, 0],
    right: [1, 0, 0],
    top: [0, 0.02, 1]
};
const SIDE_KEYS = {
    1: "front",
    2: "right",
    3: "back",
    4: "left",
    5: "top"
};

for (const [side, from] of Object.entries(SIDES)) button(`look-${side}`, () => view && view.look(...from));
button("look-reset", () => view && view.reset());
button("zoom-in", () => view && view.zoom(0.8));
button("zoom-out", () => view && view.zoom(1.25));

const ORBIT = {
    ArrowLeft: [0.1, 0],
    ArrowRight: [-0.1, 0],
    ArrowUp: [0, -0.1],
    ArrowDown: [0, 0.1]
};

function cameraKey(event) {
    if (SIDE_KEYS[event.key]) view.look(...SIDES[SIDE_KEYS[event.key]]);
    else if (event.key === "0") view.reset();
    else if (event.key === "+" || event.key === "=") view.zoom(0.8);
    else if (event.key === "-") view.zoom(1.25);
    else if (ORBIT[event.key]) view.turn(...ORBIT[event.key]);
    else return false;
    return true;
}

const PLAIN_KEYS = {
    " ": "pause",
    ".": "step",
    f: "freeze",
    r: "record",
    "?": "open-keys",
    m: "open-messages",
    c: "case",
    p: "open-parameters",
    t: "drag-turns"
};

function plainKey(event) {
    const target = byId(PLAIN_KEYS[event.key]);
    if (!target || target.offsetParent === null) return false;
    target.click();
    return true;
}

// Whether what has the focus wants the key itself.
function belongsElsewhere({target, key}) {
    if (document.querySelector("dialog[open]") || target.matches("select, textarea")) return true;
    if (target.matches("input[type=number], input[type=text]")) return true;
    if (target.matches("input"))
        return key === " " || key.startsWith("Arrow") || key.startsWith("Page") || key === "Home";
    return target.matches("button, summary, a") && key === " ";
}

document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || belongsElsewhere(event)) return;
    const probeHas = () => is("case") && sinew.state.kind === "ultrasound" && probe && !event.altKey && probe.known &&
        probe.key(event);
    if (probeHas() || (view && cameraKey(event)) || plainKey(event)) event.preventDefault();
});

// Of the shapes in the list, those that the page can draw.
for (const option of byId("shape").options)
    if (!parseShape(option.value)) throw new Error(`no shape: ${option.value}`);
connect();
