// The keyboard: one letter or sign for each action.

/**
 * @param {Document} document
 * @param {Record<string, (event: KeyboardEvent) => void>} actions by the value of KeyboardEvent.key, with
 *     "Shift+" in front of the names of arrows
 */
export function listenToKeys(document, actions) {
    document.addEventListener("keydown", event => {
        if (event.ctrlKey || event.metaKey || event.altKey || event.isComposing) return;
        if (document.querySelector("dialog[open]")) return;
        const target = event.target;
        if (target.matches("input, select, textarea") && event.key !== "Escape") return;
        // Buttons and headings have their own keys.
        if (target.matches("button, summary, a") && (event.key === " " || event.key === "Enter")) return;
        const isArrow = event.key.startsWith("Arrow");
        // Arrows scroll the panels when the focus is there.
        if (isArrow && target !== document.body && target.id !== "stage") return;
        const action = actions[isArrow && event.shiftKey ? `Shift+${event.key}` : event.key];
        if (!action) return;
        event.preventDefault();
        action(event);
    });
}
