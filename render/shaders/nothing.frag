// For depth-only passes.
void main() {}
