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

# well NAME: XML, without scripts; what gnuplot draws again is a picture too
well() {
    expect 0 '' /usr/bin/python3 -s well.py "$1"
    expect 0 '' gnuplot -e "out='again.svg'" "$1.gp"
    expect 0 '</svg>' cat again.svg
}
