// Binary messages of the protocol: tiles of one layer.

/**
 * @typedef {{x: number, y: number, width: number, height: number,
 *            values: Uint16Array | Float32Array}} Tile `values` are a view of the message, halfs as their bits.
 */

/** A message that does not follow the protocol. */
export class MalformedMessage extends Error {}

const headerBytes = 8, tileHeaderBytes = 8;

/**
 * Reads a whole message before anything is used, so that a malformed one has no effect.
 * @param {ArrayBuffer} buffer
 * @param {{epoch: number, width: number, height: number, layers: {channels: number, format: string}[]}} scene
 * @returns {{layer: number, tiles: Tile[]} | null} null: tiles of another epoch
 */
export function decodeTiles(buffer, scene) {
    if (buffer.byteLength < headerBytes) throw new MalformedMessage("too short");
    const data = new DataView(buffer);
    if (data.getUint8(0) !== 1) throw new MalformedMessage(`unknown type ${data.getUint8(0)}`);
    if (!scene || data.getUint32(4, true) !== scene.epoch) return null;
    const index = data.getUint8(1), channels = data.getUint8(2), bytes = data.getUint8(3);
    const layer = scene.layers[index];
    if (!layer) throw new MalformedMessage(`no layer ${index}`);
    if (channels !== layer.channels || bytes !== (layer.format === "half" ? 2 : 4))
        throw new MalformedMessage("unexpected format");
    const tiles = [];
    for (let at = headerBytes; at < buffer.byteLength;) {
        if (at + tileHeaderBytes > buffer.byteLength) throw new MalformedMessage("truncated tile");
        const [x, y, width, height] = [0, 2, 4, 6].map(i => data.getUint16(at + i, true));
        at += tileHeaderBytes;
        const count = width * height * channels;
        if (!count || x + width > scene.width || y + height > scene.height)
            throw new MalformedMessage("tile outside the picture");
        if (at + count * bytes > buffer.byteLength) throw new MalformedMessage("truncated tile");
        const values = bytes === 2 ? new Uint16Array(buffer, at, count) : new Float32Array(buffer, at, count);
        tiles.push({x, y, width, height, values});
        at += count * bytes;
    }
    return {layer: index, tiles};
}
