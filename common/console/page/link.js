// The connection, in a worker: it reads all that comes at once, however busy the page is with drawing, and keeps of
// frames, images and positions the newest alone. The page asks for the next when it is done with one, and the server
// sends the next image and positions only then, so that nobody works for what is never shown. Images are decoded here;
// a browser of this machine gets them as they are, because decoding one takes far longer than sending it.
//
// From the page: {address, raw} to begin, {send} a line, {done} with what it was given, {drawn} the positions that
// came. To the page: {open: true or false}, {problem} in words, {data} a message; of a JPEG {header, pixels}: the
// message's first bytes and an ImageBitmap, null where the pixels are those of the image before.

const AGAIN = [500, 1000, 2000, 5000];                               // ms, between attempts to connect
const KINDS = ["frame", "image", "geometry", "positions", "image"];  // binary ones by their numbers
const PIXELS = 4;

let address = null;
let raw = false;  // whether images come as they are
let socket = null;
let tries = 0;
let asked = true;   // whether the page waits for a message
let drawn = true;   // whether it has drawn the positions that it got
const HEADER = 96;  // bytes of an image before its JPEG
let image = null;   // waits to be decoded
let decoding = false;
let shown = new Uint8Array();  // what was decoded last

const texts = [];  // all of these count, in their order
const newest = new Map();

function connect() {
    socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
        tries = 0;
        if (raw) socket.send("pixels raw");
        postMessage({open: true});
    };
    socket.onmessage = ({data}) => receive(data);
    socket.onclose = () => {
        postMessage({open: false});
        setTimeout(connect, AGAIN[Math.min(tries++, AGAIN.length - 1)]);
    };
}

function receive(data) {
    const isText = typeof data === "string";
    const kind = isText ? kindOfText(data) : KINDS[new DataView(data).getUint32(0, true)];
    // Positions of before are of another geometry.
    if (kind === "geometry" && newest.delete("positions")) say("got positions");
    if (kind === "image" && isJpeg(data)) takeImage(data);
    else if (kind === "frame" || kind === "positions" || kind === "image") newest.set(kind, data);
    else texts.push(data);
    give();
}

const kindOfText = (data) => (/^\s*\{\s*"type"\s*:\s*"frame"/.test(data) ? "frame" : "text");

const isJpeg = (data) => new DataView(data).getUint32(0, true) !== PIXELS;

function takeImage(data) {
    image = data;
    if (!decoding) decodeNext();
}

async function decodeNext() {
    decoding = true;
    const header = image.slice(0, HEADER);
    const bytes = new Uint8Array(image, HEADER);
    image = null;
    try {
        if (isSame(bytes, shown)) keepImage(header, null);
        else keepImage(header, await createImageBitmap(new Blob([bytes], {type: "image/jpeg"})));
        shown = bytes;
    } catch (error) {
        postMessage({problem: `an image that this browser cannot read: ${error.message}`});
    }
    decoding = false;
    give();
    if (image) decodeNext();
}

function isSame(a, b) {
    if (a.length !== b.length) return false;
    for (let i = 0; i < a.length; i++)
        if (a[i] !== b[i]) return false;
    return true;
}

// Of an image that the page has not taken, the pixels count where the next has none of its own.
function keepImage(header, pixels) {
    const before = newest.get("image");
    if (before && before.pixels && before.pixels.close && pixels) before.pixels.close();
    newest.set("image", {header, pixels: pixels || (before ? before.pixels : null)});
}

function say(line) {
    if (socket && socket.readyState === WebSocket.OPEN) socket.send(line);
}

// The oldest of what counts, else what has waited longest.
function give() {
    if (!asked) return;
    const [kind, next] = texts.length ? ["text", texts.shift()] : takeOne();
    if (next === undefined) return;
    asked = false;
    postMessage({data: next}, transfers(next));
    if (kind === "positions") drawn = false;
    if (kind === "image" || kind === "positions") say(`got ${kind}`);
}

// What the page gets without a copy.
function transfers(next) {
    if (typeof next === "string") return [];
    if (!next.header) return [next];
    return next.pixels ? [next.header, next.pixels] : [next.header];
}

function takeOne() {
    for (const [kind, data] of newest) {
        if (kind === "positions" && !drawn) continue;
        newest.delete(kind);
        return [kind, data];
    }
    return [];
}

onmessage = ({data}) => {
    if (data.address) {
        address = data.address;
        raw = data.raw;
        connect();
    } else if (data.send !== undefined) {
        say(data.send);
    } else if (data.drawn) {
        drawn = true;
        give();
    } else {
        asked = true;
        give();
    }
};
