// Saves the displayed picture from the page itself, once the program no longer answers.

/**
 * @param {Uint8ClampedArray} rgba from the top
 * @param {{width: number, height: number}} size
 * @param {string} name of the file
 */
export function savePicture(rgba, {width, height}, name) {
    const canvas = Object.assign(document.createElement("canvas"), {width, height});
    canvas.getContext("2d").putImageData(new ImageData(rgba, width, height), 0, 0);
    canvas.toBlob(blob => {
        const link = Object.assign(document.createElement("a"), {href: URL.createObjectURL(blob), download: name});
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
}
