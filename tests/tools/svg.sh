# What test scripts of charts share; sourced after tap.sh.
# shellcheck shell=sh
cat >well.py <<'END'
import sys, xml.etree.ElementTree as xml
root = xml.parse(sys.argv[1]).getroot()
assert root.tag.endswith("svg")
for node in root.iter():
    assert not node.tag.endswith("script")
    assert not any(k.startswith("on") for k in node.attrib)
END

cat >words.py <<'END'
"""Words of a picture as a reader finds them: text, x, y and size in pixels."""
import re, sys, xml.etree.ElementTree as xml

def words(name):
    found = []
    for node in xml.parse(name).getroot().iter():
        text = [t for t in node if t.tag.endswith("text")]
        if not text or "transform" not in node.attrib:
            continue
        place = re.fullmatch(r"translate\(([\d.-]+),([\d.-]+)\)(.*)",
                             node.get("transform"))
        said = "".join(text[0].itertext()).strip()
        if not said or "rotate" in place[3]:
            continue
        # half an em a letter is less than any font has
        high, wide = float(node.get("font-size")), len(said)
        wide *= 0.45 * float(node.get("font-size"))
        x, y = float(place[1]), float(place[2])
        x -= {"start": 0, "middle": wide / 2, "end": wide}[
            node.get("text-anchor")]
        found.append((said.replace("\u00a0", " "), x, y, high, wide))
    for i, a in enumerate(found):
        for b in found[:i]:
            assert (a[1] >= b[1] + b[4] or b[1] >= a[1] + a[4] or
                    a[2] - 0.7 * a[3] >= b[2] or b[2] - 0.7 * b[3] >= a[2]), \
                (name, a, b)
    return [w[:4] for w in found]

if __name__ == "__main__":
    assert words(sys.argv[1])
END

# well NAME: the picture is XML without scripts, and no word covers another. Its
# script draws it again without a warning in a UTF-8 locale; in other locales
# gnuplot warns about the degree sign.
well() {
    expect 0 '' /usr/bin/python3 -s well.py "$1"
    expect 0 '' /usr/bin/python3 -s words.py "$1"
    rm -f again.svg
    works '  and gnuplot draws it again without a word' \
        test -z "$(LC_ALL=C.UTF-8 gnuplot -d -e "out='again.svg'" \
            "./$1.gp" 2>&1)"
    expect 0 '</svg>' cat again.svg
}
