// The connection, in a worker: it reads all that comes at once, however busy the page is with drawing, and keeps of
// frames, images and positions the newest alone. The page asks for the next when it is done with one, so that what it
// shows is never older than one drawing. Images are decoded here, one after the other.
//
// From the page: {address} to begin, {send} a line, {done} with what it was given.
// To the page: {open: true or false}, {problem} in words, {data} a message; of an image {header, bitmap}: the message's
// first bytes and its pixels, null where they are those of the image before.

const AGAIN = [500, 1000, 2000, 5000];                      // ms, between attempts to connect
const KINDS = ["frame", "image", "geometry", "positions"];  // binary ones by their numbers

let address = null;
let socket = null;
let tries = 0;
let asked = true;   // whether the page waits for a message
const HEADER = 96;  // bytes of an image before its JPEG
let image = null;   // waits to be decoded
let decoding = false;
let shown = new Uint8Array();  // the JPEG that was decoded last

const texts = [];  // all of these count, in their order
const newest = new Map();

function connect() {
    socket = new WebSocket(address);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
        tries = 0;
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
    if (kind === "geometry") newest.delete("positions");
    if (kind === "image") takeImage(data);
    else if (kind === "frame" || kind === "positions") newest.set(kind, data);
    else texts.push(data);
    give();
}

const kindOfText = (data) => (/^\s*\{\s*"type"\s*:\s*"frame"/.test(data) ? "frame" : "text");

function takeImage(data) {
    image = data;
    if (!decoding) decodeNext();
}

async function decodeNext() {
    decoding = true;
    const header = image.slice(0, HEADER);
    const jpeg = new Uint8Array(image, HEADER);
    image = null;
    try {
        const isNew = jpeg.length !== shown.length || jpeg.some((byte, i) => byte !== shown[i]);
        keepImage(header, isNew ? await createImageBitmap(new Blob([jpeg], {type: "image/jpeg"})) : null);
        shown = jpeg;
    } catch (error) {
        postMessage({problem: `an image that this browser cannot read: ${error.message}`});
    }
    decoding = false;
    give();
    if (image) decodeNext();
}

// Of an image that the page has not taken, the pixels count where the next has none of its own.
function keepImage(header, bitmap) {
    const before = newest.get("image");
    if (before && before.bitmap && bitmap) before.bitmap.close();
    newest.set("image", {header, bitmap: bitmap || (before ? before.bitmap : null)});
}

// The oldest of what counts, else what has waited longest.
function give() {
    if (!asked) return;
    const next = texts.length ? texts.shift() : takeOne();
    if (next === undefined) return;
    asked = false;
    postMessage({data: next}, transfers(next));
}

// What the page gets without a copy.
function transfers(next) {
    if (typeof next === "string") return [];
    if (!next.header) return [next];
    return next.bitmap ? [next.header, next.bitmap] : [next.header];
}

function takeOne() {
    for (const [kind, data] of newest) {
        newest.delete(kind);
        return data;
    }
    return undefined;
}

onmessage = ({data}) => {
    if (data.address) {
        address = data.address;
        connect();
    } else if (data.send !== undefined) {
        if (socket && socket.readyState === WebSocket.OPEN) socket.send(data.send);
    } else {
        asked = true;
        give();
    }
};
