# `paper_page.py PAGE.html PAGE.txt`: what a page of samples/paper must be; a line for each thing that is wrong.
import base64
import re
import sys
import xml.etree.ElementTree as tree

text = open(sys.argv[1], encoding="ascii").read()
root = tree.fromstring(text.replace("<!DOCTYPE html>", "", 1))


def numbers(of):
    return re.findall(r"[0-9]+(?:[.][0-9]+)?", of)


for element in root.iter():
    for name in ("src", "href", "srcset", "data", "action"):
        value = element.get(name)
        if value is not None and not value.startswith(("data:image/png;base64,", "data:image/svg+xml;base64,", "#")):
            print(f"{element.tag}: {name} leads elsewhere: {value[:60]}")
        elif value is not None and value.startswith("data:"):
            head = base64.b64decode(value.split(",", 1)[1], validate=True)
            if not (head.startswith(b"\x89PNG\r\n") or b"<svg" in head[:400]):
                print(f"{element.tag}: {name} is no picture")
    if element.tag in ("script", "link", "iframe", "object"):
        print(f"there is a {element.tag}")
    if element.tag == "img" and not element.get("alt"):
        print("a picture without words in its place")
if re.search(r"url\(|@import", root.find("head/style").text):
    print("the style leads elsewhere")
names = [e.get("id") for e in root.iter() if e.get("id")]
if len(set(names)) != len(names):
    print("two places of one name")
for a in root.iter("a"):
    if a.get("href")[1:] not in names:
        print(f"no place {a.get('href')}")
body = root.find("body")
body.remove(body.find("nav"))
here = numbers(" ".join(body.itertext()))
there = numbers(re.sub(r"\[\S+[.](png|svg)\]", "", open(sys.argv[2], encoding="ascii").read()))
if here != there or len(here) < 3:
    at = next((i for i, (a, b) in enumerate(zip(here, there)) if a != b), min(len(here), len(there)))
    print(f"{len(here)} numbers here, {len(there)} in the text; from number {at} {here[at:at + 5]} and {there[at:at + 5]}")
